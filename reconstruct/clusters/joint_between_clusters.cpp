// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/joint_between_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <ceres/ceres.h>
#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/transform.h"
#include "reconstruct/clusters/cluster_frame.h"
#include "reconstruct/clusters/cluster_shape.h"
#include "reconstruct/clusters/find_joint_centres.h"
#include "reconstruct/clusters/joint_residuals.h"

namespace marey::reconstruct {
namespace {

constexpr std::size_t kMinFrames = 20;
constexpr double kCauchy = 3.0;  // [sigma]
// Lower bound of the soft tissue's movement per radian.
constexpr double kMinSoft_m = 0.0001;

/// One frame's unknowns: place of the first segment, the correction to its initial
/// rotation, and the joint's rotation, as a rotation vector from b to a.
using FrameBlock = std::array<double, 9>;

struct Instant {
  std::size_t frame = 0;
  glm::dquat world_from_a{1.0, 0.0, 0.0, 0.0};  ///< Initial rotation.
  FrameBlock unknown{};
};

using Shape = std::vector<std::array<double, 3>>;
using Softness = std::vector<std::array<double, 9>>;  ///< [m/rad], row by row.

/// Estimates the slide of markers per radian from their relative movement: regression of
/// the residuals of a rigid shape on the joint's rotation.
double expected_softness(const MarkerCluster& cluster,
                         const std::vector<glm::dvec3>& shape,
                         std::span<const Instant> instants,
                         const Eigen::Vector3d& mean,
                         double noise_m) {
  double seen_m2 = 0.0;
  double turned_rad2 = 0.0;
  double chance_m2 = 0.0;
  for (std::size_t m = 0; m < cluster.markers; ++m) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
    for (const Instant& i : instants) {
      const auto& p = cluster.p_in_world[i.frame * cluster.markers + m];
      if (!p) continue;
      const glm::dvec3 off = locate(cluster, shape, i.frame) * *p - shape[m];
      const Eigen::Vector3d turn =
          Eigen::Map<const Eigen::Vector3d>(&i.unknown[6]) - mean;
      normal += turn * turn.transpose();
      right += turn * Eigen::Vector3d(off.x, off.y, off.z).transpose();
    }
    const Eigen::Matrix3d soft = normal.ldlt().solve(right);
    seen_m2 += (soft.transpose() * normal * soft).trace();
    chance_m2 += 9.0 * noise_m * noise_m;
    turned_rad2 += normal.trace();
  }
  // A rigid fit absorbs six of the shape's freedoms.
  const auto freedoms = static_cast<double>(3 * cluster.markers);
  const double hidden = freedoms / std::max(3.0, freedoms - 6.0);
  const double variance =
      hidden * std::max(0.0, seen_m2 - 1.5 * chance_m2) / (3.0 * turned_rad2);
  return std::sqrt(variance + kMinSoft_m * kMinSoft_m);
}

class ClusterJointProblem {
 public:
  ClusterJointProblem(const MarkerCluster& a,
                      const MarkerCluster& b,
                      const ClusterJointOptions& options,
                      std::vector<glm::dvec3> shape_a,
                      std::vector<glm::dvec3> shape_b)
      : a_(a),
        b_(b),
        noise_m_(options.noise_m),
        start_a_(std::move(shape_a)),
        start_b_(std::move(shape_b)) {}

  bool start(std::span<const std::size_t> frames) {
    std::vector<SegmentPair> pairs;
    for (const std::size_t f : frames) {
      pairs.push_back(
          {inverse(locate(a_, start_a_, f)), inverse(locate(b_, start_b_, f))});
    }
    const auto centre = find_joint_centre(pairs, glm::dvec3(0.0), glm::dvec3(0.0));
    if (!centre) return false;
    joint_in_a_ = {centre->p_in_a.x, centre->p_in_a.y, centre->p_in_a.z};
    joint_in_b_ = {centre->p_in_b.x, centre->p_in_b.y, centre->p_in_b.z};
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Instant instant;
      instant.frame = frames[i];
      instant.world_from_a = pairs[i].world_from_a.rotation;
      const glm::dvec3& t = pairs[i].world_from_a.translation;
      const glm::dvec3 turn =
          rotation_vector(glm::conjugate(pairs[i].world_from_a.rotation) *
                          pairs[i].world_from_b.rotation);
      instant.unknown = {t.x, t.y, t.z, 0.0, 0.0, 0.0, turn.x, turn.y, turn.z};
      instants_.push_back(instant);
    }
    for (const Instant& i : instants_) {
      mean_turn_ += Eigen::Map<const Eigen::Vector3d>(&i.unknown[6]) /
                    static_cast<double>(instants_.size());
    }
    soft_sigma_a_ = expected_softness(a_, start_a_, instants_, mean_turn_, noise_m_);
    soft_sigma_b_ = expected_softness(b_, start_b_, instants_, mean_turn_, noise_m_);
    shape_a_ = blocks(start_a_);
    shape_b_ = blocks(start_b_);
    soft_a_.assign(shape_a_.size(), {});
    soft_b_.assign(shape_b_.size(), {});
    return true;
  }

  std::optional<ClusterJoint> solve() {
    ceres::Problem problem;
    add_sights(problem);
    add_expectations(problem);
    hold_frame(problem, start_a_, shape_a_);
    hold_frame(problem, start_b_, shape_b_);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (Instant& i : instants_) {
      options.linear_solver_ordering->AddElementToGroup(i.unknown.data(), 0);
    }
    for (auto* shape : {&shape_a_, &shape_b_}) {
      for (auto& p : *shape)
        options.linear_solver_ordering->AddElementToGroup(p.data(), 1);
    }
    for (auto* soft : {&soft_a_, &soft_b_}) {
      for (auto& s : *soft)
        options.linear_solver_ordering->AddElementToGroup(s.data(), 1);
    }
    options.linear_solver_ordering->AddElementToGroup(joint_in_a_.data(), 1);
    options.linear_solver_ordering->AddElementToGroup(joint_in_b_.data(), 1);
    options.max_num_iterations = 50;
    options.function_tolerance = 1e-9;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    return describe(problem);
  }

 private:
  static Shape blocks(const std::vector<glm::dvec3>& points) {
    Shape shape;
    for (const glm::dvec3& p : points) shape.push_back({p.x, p.y, p.z});
    return shape;
  }

  void add_sights(ceres::Problem& problem) {
    for (Instant& i : instants_) {
      for (const std::size_t m : seen_markers(a_, i.frame)) {
        auto* cost = new SeenOnA{{*a_.p_in_world[i.frame * a_.markers + m],
                                  i.world_from_a,
                                  mean_turn_,
                                  noise_m_}};
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<SeenOnA, 3, 9, 3, 9>(cost),
            new ceres::CauchyLoss(kCauchy),
            i.unknown.data(),
            shape_a_[m].data(),
            soft_a_[m].data());
      }
      for (const std::size_t m : seen_markers(b_, i.frame)) {
        auto* cost = new SeenOnB{{*b_.p_in_world[i.frame * b_.markers + m],
                                  i.world_from_a,
                                  mean_turn_,
                                  noise_m_}};
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<SeenOnB, 3, 9, 3, 9, 3, 3>(cost),
            new ceres::CauchyLoss(kCauchy),
            i.unknown.data(),
            shape_b_[m].data(),
            soft_b_[m].data(),
            joint_in_a_.data(),
            joint_in_b_.data());
      }
    }
  }

  /// Removes the freedom of a shape's frame by its markers: the first is held, the second
  /// moves along one axis only, the third along two.
  static void hold_frame(ceres::Problem& problem,
                         const std::vector<glm::dvec3>& start,
                         Shape& shape) {
    const auto longest = [](const glm::dvec3& v) {
      const glm::dvec3 size = glm::abs(v);
      return size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    };
    // The second is the one furthest from the first, the third furthest from their line.
    std::size_t second = 1;
    for (std::size_t m = 2; m < start.size(); ++m) {
      if (glm::distance(start[m], start[0]) > glm::distance(start[second], start[0])) {
        second = m;
      }
    }
    const glm::dvec3 along = start[second] - start[0];
    std::size_t third = 0;
    glm::dvec3 across(0.0);
    for (std::size_t m = 1; m < start.size(); ++m) {
      const glm::dvec3 normal = glm::cross(along, start[m] - start[0]);
      if (glm::length(normal) <= glm::length(across)) continue;
      third = m;
      across = normal;
    }
    problem.SetParameterBlockConstant(shape[0].data());
    const int free = longest(along);
    problem.SetManifold(shape[second].data(),
                        new ceres::SubsetManifold(3, {(free + 1) % 3, (free + 2) % 3}));
    problem.SetManifold(shape[third].data(),
                        new ceres::SubsetManifold(3, {longest(across)}));
  }

  void add_expectations(ceres::Problem& problem) {
    const auto expect = [&](Softness& soft, double soft_sigma) {
      for (std::size_t m = 0; m < soft.size(); ++m) {
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<FirmTissue, 9, 9>(new FirmTissue{soft_sigma}),
            nullptr,
            soft[m].data());
      }
    };
    expect(soft_a_, soft_sigma_a_);
    expect(soft_b_, soft_sigma_b_);
  }

  /// Returns the root mean square, per marker, of its movement by soft tissue about the
  /// mean.
  double soft_tissue_m(const Softness& soft) const {
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const Instant& i : instants_) {
      const Eigen::Vector3d turn =
          Eigen::Map<const Eigen::Vector3d>(&i.unknown[6]) - mean_turn_;
      second += turn * turn.transpose() / static_cast<double>(instants_.size());
    }
    double sum = 0.0;
    for (const auto& block : soft) {
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> s(
          block.data());
      sum += (s * second * s.transpose()).trace();
    }
    return std::sqrt(sum / static_cast<double>(soft.size()));
  }

  std::optional<ClusterJoint> describe(ceres::Problem& problem) {
    ClusterJoint found;
    // The shapes' frames have moved slightly in the solution: converts to those of the
    // start.
    const auto settle = [](const Shape& shape,
                           const std::vector<glm::dvec3>& start,
                           const std::array<double, 3>& joint,
                           std::vector<glm::dvec3>& shape_out) {
      for (const auto& p : shape) shape_out.emplace_back(p[0], p[1], p[2]);
      const RigidTransform start_from_shape =
          align(shape_out, start, std::vector<double>(start.size(), 1.0));
      for (glm::dvec3& p : shape_out) p = start_from_shape * p;
      return start_from_shape * glm::dvec3(joint[0], joint[1], joint[2]);
    };
    found.p_in_a = settle(shape_a_, start_a_, joint_in_a_, found.shape_a);
    found.p_in_b = settle(shape_b_, start_b_, joint_in_b_, found.shape_b);
    found.soft_tissue_a_m = soft_tissue_m(soft_a_);
    found.soft_tissue_b_m = soft_tissue_m(soft_b_);
    ceres::Problem::EvaluateOptions evaluate;
    evaluate.apply_loss_function = false;
    std::vector<double> residuals;
    problem.Evaluate(evaluate, nullptr, &residuals, nullptr, nullptr);
    const std::size_t priors = 9 * (shape_a_.size() + shape_b_.size());
    double sum = 0.0;
    for (std::size_t i = 0; i + priors < residuals.size(); ++i) {
      sum += residuals[i] * residuals[i];
    }
    found.rms_m =
        noise_m_ * std::sqrt(sum / static_cast<double>(residuals.size() - priors));
    const auto covariance = joint_covariance(problem);
    if (!covariance) return std::nullopt;
    const double factor = std::max(1.0, found.rms_m / noise_m_);
    found.sigma_a_m = factor * std::sqrt(covariance->block<3, 3>(0, 0).trace() / 3.0);
    found.sigma_b_m = factor * std::sqrt(covariance->block<3, 3>(3, 3).trace() / 3.0);
    return found;
  }

  /// Computes the covariance of the joint in a, then in b, with all other unknowns free.
  /// [m^2]
  std::optional<Eigen::Matrix<double, 6, 6>> joint_covariance(ceres::Problem& problem) {
    ceres::Problem::EvaluateOptions evaluate;
    for (Instant& i : instants_) evaluate.parameter_blocks.push_back(i.unknown.data());
    for (auto* shape : {&shape_a_, &shape_b_}) {
      // The first is held.
      for (std::size_t m = 1; m < shape->size(); ++m) {
        evaluate.parameter_blocks.push_back((*shape)[m].data());
      }
    }
    for (auto* soft : {&soft_a_, &soft_b_}) {
      for (auto& s : *soft) evaluate.parameter_blocks.push_back(s.data());
    }
    evaluate.parameter_blocks.push_back(joint_in_a_.data());
    evaluate.parameter_blocks.push_back(joint_in_b_.data());
    ceres::CRSMatrix rows;
    problem.Evaluate(evaluate, nullptr, nullptr, nullptr, &rows);
    const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
        rows.num_rows,
        rows.num_cols,
        static_cast<Eigen::Index>(rows.values.size()),
        rows.rows.data(),
        rows.cols.data(),
        rows.values.data());
    const Eigen::SparseMatrix<double> normal = jacobian.transpose() * jacobian;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(normal);
    if (ldlt.info() != Eigen::Success) return std::nullopt;
    Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(rows.num_cols, 6);
    wanted.bottomRows<6>().setIdentity();
    return Eigen::Matrix<double, 6, 6>(ldlt.solve(wanted).bottomRows<6>());
  }

  const MarkerCluster& a_;
  const MarkerCluster& b_;
  double noise_m_;
  std::vector<glm::dvec3> start_a_;
  std::vector<glm::dvec3> start_b_;
  std::vector<Instant> instants_;
  Eigen::Vector3d mean_turn_ = Eigen::Vector3d::Zero();
  Shape shape_a_;
  Shape shape_b_;
  Softness soft_a_;
  Softness soft_b_;
  double soft_sigma_a_ = 0.0;
  double soft_sigma_b_ = 0.0;
  std::array<double, 3> joint_in_a_{};
  std::array<double, 3> joint_in_b_{};
};

}  // namespace

std::optional<ClusterJoint> joint_between_clusters(const MarkerCluster& a,
                                                   const MarkerCluster& b,
                                                   const ClusterJointOptions& options) {
  if (a.markers < kMinClusterMarkers || b.markers < kMinClusterMarkers)
    return std::nullopt;
  const std::size_t frames = a.p_in_world.size() / a.markers;
  MAREY_ASSERT(frames * b.markers == b.p_in_world.size());
  std::vector<std::size_t> usable;
  for (std::size_t f = 0; f < frames; ++f) {
    if (seen_markers(a, f).size() < kMinClusterMarkers) continue;
    if (seen_markers(b, f).size() < kMinClusterMarkers) continue;
    usable.push_back(f);
  }
  if (usable.size() < kMinFrames) return std::nullopt;
  auto shape_a = find_shape(a, usable);
  auto shape_b = find_shape(b, usable);
  if (!shape_a || !shape_b) return std::nullopt;
  ClusterJointProblem problem(a, b, options, std::move(*shape_a), std::move(*shape_b));
  if (!problem.start(usable)) return std::nullopt;
  return problem.solve();
}

}  // namespace marey::reconstruct
