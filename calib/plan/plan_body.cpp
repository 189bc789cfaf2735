// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/plan_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Dense>
#include <glm/vec2.hpp>

#include "calib/plan/body_information.h"
#include "calib/plan/posture_chain.h"
#include "calib/plan/subject_uncertainty.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/human/posture_priors.h"

namespace marey::calib {
namespace {

constexpr double kSpeed_m_s = 1.2;
constexpr double kStride_m = 1.35;  ///< Length of two steps.
constexpr double kWalk_s = 1.2;     ///< Slightly more than a stride.
constexpr double kMargin_s = 0.2;   ///< At either end; frames there have few neighbours.

/// Even, as required by solve_chain().
int frames_of_a_walk(double rate_hz) {
  return 2 * std::max(1, static_cast<int>(std::lround(0.5 * kWalk_s * rate_hz)));
}

/// Returns the joints with ground truth in rendered recordings.
std::vector<HumanBone> limb_joints() {
  std::vector<HumanBone> joints;
  for (const HumanLimb& limb : human_limbs()) {
    joints.insert(joints.end(), {limb.upper, limb.lower, limb.end});
  }
  return joints;
}

/// Observability and occlusion of a body at one position.
struct SeenBody {
  FrameInformation information;
  PostureJacobian jacobian;
  std::vector<bool> measured;  ///< Per bone.
  int seen = 0;                ///< Number of tags.
  int seen_twice = 0;
};

class BodyPlanner {
 public:
  BodyPlanner(std::span<const Camera> cameras,
              const RigCovariance* covariance,
              const PlannedBody& body,
              const ErrorMapGrid& grid,
              const CornerSigma& corner_sigma,
              const PlanBodyOptions& options)
      : cameras_(cameras),
        body_(body),
        grid_(grid),
        sigma_(corner_sigma),
        options_(options),
        columns_{static_cast<int>(body.tags.size()), static_cast<int>(cameras.size())},
        joints_(limb_joints()),
        errors_(joints_.size()),
        measured_(joints_.size(), 0),
        lasting_(joints_.size()) {
    const glm::dvec3 middle = 0.5 * (grid.min_in_world + grid.max_in_world);
    shared_ = subject_uncertainty(cameras,
                                  covariance,
                                  body,
                                  {middle.x, middle.z},
                                  corner_sigma,
                                  options.tags,
                                  columns_);
  }

  void walk(double heading_rad, const glm::dvec2& middle_m) {
    std::vector<SeenBody> frames;
    std::vector<FrameInformation> information;
    const glm::dvec2 way{std::sin(heading_rad), std::cos(heading_rad)};
    const int count_of_frames = frames_of_a_walk(options_.rate_hz);
    for (int f = 0; f < count_of_frames; ++f) {
      const double travelled_m =
          (f - 0.5 * (count_of_frames - 1)) * kSpeed_m_s / options_.rate_hz;
      const double phase = 2.0 * std::numbers::pi * travelled_m / kStride_m + heading_rad;
      frames.push_back(seen_body(
          walking_body(body_, middle_m + travelled_m * way, heading_rad, phase)));
      information.push_back(std::move(frames.back().information));
    }
    const auto uncertainties = solve_chain(information, step_prior({options_.rate_hz}));
    const auto run_up =
        static_cast<std::size_t>(std::lround(kMargin_s * options_.rate_hz));
    for (std::size_t f = run_up; f + run_up < frames.size(); ++f) {
      count(frames[f], uncertainties[f]);
    }
  }

  PlannedStand stand(const glm::dvec2& floor_m) {
    PlannedStand out;
    out.p_on_floor = {floor_m.x, 0.0, floor_m.y};
    std::vector<double> errors_m;
    for (int k = 0; k < options_.headings; ++k) {
      const double heading_rad = 2.0 * std::numbers::pi * k / options_.headings;
      const SeenBody seen = seen_body(standing_body(body_, floor_m, heading_rad));
      for (const HumanBone bone : joints_) {
        out.measured_share += seen.measured[index(bone)] ? 1.0 : 0.0;
      }
      if (!is_found(seen)) continue;
      const Eigen::LLT<PostureMatrix> factor(seen.information.posture);
      const PostureUncertainty uncertainty{factor.solve(PostureMatrix::Identity()),
                                           -factor.solve(seen.information.coupling)};
      for (const Eigen::Matrix3d& sum : joint_covariances(seen, uncertainty)) {
        errors_m.push_back(std::sqrt(sum.trace()));
      }
    }
    out.measured_share /= static_cast<double>(joints_.size()) * options_.headings;
    if (!errors_m.empty()) out.error_m = median(std::move(errors_m));
    return out;
  }

  BodyPlan plan() {
    BodyPlan out;
    const double all = std::max(1, frames_);
    const double tags =
        all * std::max<double>(1.0, static_cast<double>(body_.tags.size()));
    out.found_share = found_ / all;
    out.views_share = seen_ / tags;
    out.twice_share = seen_twice_ / tags;
    for (const int measured : measured_) {
      out.measured_share += measured / all / static_cast<double>(joints_.size());
    }
    if (found_ == 0) return out;
    std::vector<double> pooled;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      out.joints.push_back(
          {joints_[j], measured_[j] / all, spread(errors_[j]), median(lasting_[j])});
      pooled.insert(pooled.end(), errors_[j].begin(), errors_[j].end());
    }
    out.error_m = spread(pooled);
    return out;
  }

 private:
  static MedianAndP95 spread(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0.95)};
  }

  static bool is_found(const SeenBody& seen) {
    return seen.measured[index(HumanBone::kHips)] ||
           seen.measured[index(HumanBone::kUpperChest)];
  }

  SeenBody seen_body(const BodyPlace& place) const {
    SeenBody out;
    const auto views = views_of(cameras_, body_, place, options_.tags);
    out.jacobian = posture_jacobian(body_, place);
    out.measured.assign(kHumanBoneCount, false);
    std::vector<int> cameras_of_tag(body_.tags.size(), 0);
    for (const BodyView& view : views) {
      out.measured[index(body_.tags[view.tag].tag.segment)] = true;
      ++cameras_of_tag[view.tag];
    }
    for (const int cameras : cameras_of_tag) {
      out.seen += cameras >= 1 ? 1 : 0;
      out.seen_twice += cameras >= 2 ? 1 : 0;
    }
    out.information =
        information_of(cameras_, body_, place, out.jacobian, views, sigma_, columns_);
    add_posture_prior(posture_prior_rows(place, out.jacobian, kArmTwistSigma_rad),
                      out.information);
    return out;
  }

  std::vector<Eigen::Matrix3d> joint_covariances(
      const SeenBody& seen,
      const PostureUncertainty& uncertainty,
      std::vector<std::vector<double>>* lasting_m = nullptr) const {
    const auto count = static_cast<Eigen::Index>(joints_.size());
    Eigen::MatrixXd by_posture(3 * count, kPostureColumns);
    Eigen::MatrixXd by_length(3 * count, kLengthColumns);
    Eigen::MatrixXd by_base(3 * count, kBaseColumns);
    for (Eigen::Index j = 0; j < count; ++j) {
      const std::size_t bone = index(joints_[static_cast<std::size_t>(j)]);
      by_posture.middleRows<3>(3 * j) = seen.jacobian.origin[bone];
      by_length.middleRows<3>(3 * j) = seen.jacobian.origin_by_length[bone];
      by_base.middleRows<3>(3 * j) = seen.jacobian.origin_by_base[bone];
    }
    Eigen::MatrixXd follows = by_posture * uncertainty.by_shared;
    follows.leftCols(kLengthColumns) += by_length;
    follows.rightCols(kBaseColumns) += by_base;
    const Eigen::MatrixXd carried = follows * shared_;
    std::vector<Eigen::Matrix3d> out;
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto rows = by_posture.middleRows<3>(3 * j);
      const Eigen::Matrix3d lasting =
          carried.middleRows<3>(3 * j) * follows.middleRows<3>(3 * j).transpose();
      out.emplace_back(rows * uncertainty.covariance * rows.transpose() + lasting);
      if (lasting_m) {
        (*lasting_m)[static_cast<std::size_t>(j)].push_back(std::sqrt(lasting.trace()));
      }
    }
    return out;
  }

  void count(const SeenBody& seen, const PostureUncertainty& uncertainty) {
    ++frames_;
    seen_ += seen.seen;
    seen_twice_ += seen.seen_twice;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      measured_[j] += seen.measured[index(joints_[j])] ? 1 : 0;
    }
    if (!is_found(seen)) return;
    ++found_;
    const auto sums = joint_covariances(seen, uncertainty, &lasting_);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(sums[j]);
      const Eigen::Array3d sigma_m = axes.eigenvalues().array().max(0.0).sqrt();
      constexpr int kDraws = 4;
      for (int draw = 0; draw < kDraws; ++draw) {
        const Eigen::Array3d unit{normal(), normal(), normal()};
        errors_[j].push_back((sigma_m * unit).matrix().norm());
      }
    }
  }

  /// Returns a normal deviate of unit sigma, by Box and Muller: std::normal_distribution
  /// differs between libraries.
  double normal() {
    const auto uniform = [&] {
      return (static_cast<double>(dice_()) + 0.5) / 4294967296.0;
    };
    const double length = std::sqrt(-2.0 * std::log(uniform()));
    return length * std::cos(2.0 * std::numbers::pi * uniform());
  }

  std::span<const Camera> cameras_;
  const PlannedBody& body_;
  const ErrorMapGrid& grid_;
  const CornerSigma& sigma_;
  const PlanBodyOptions& options_;
  SharedColumns columns_;
  std::vector<HumanBone> joints_;
  Eigen::MatrixXd shared_;  ///< Covariance of the shared columns.
  std::mt19937 dice_{20};
  std::vector<std::vector<double>> errors_;
  std::vector<int> measured_;
  std::vector<std::vector<double>> lasting_;
  int frames_ = 0;
  int found_ = 0;
  int seen_ = 0;
  int seen_twice_ = 0;
};

/// Returns the digits of `i` in `base`, mirrored at the point: evenly spread over 0 to 1
/// (Halton).
double mirrored_digits(int i, int base) {
  double out = 0.0;
  for (double part = 1.0 / base; i > 0; i /= base, part /= base) out += part * (i % base);
  return out;
}

}  // namespace

BodyPlan plan_body(std::span<const Camera> cameras,
                   const RigCovariance* covariance,
                   const PlannedBody& body,
                   const ErrorMapGrid& grid,
                   const CornerSigma& corner_sigma,
                   const PlanBodyOptions& options) {
  MAREY_ASSERT(!cameras.empty() && options.step_m > 0.0 && options.rate_hz > 0.0);
  MAREY_ASSERT(options.headings > 0 && options.strides > 0);
  MAREY_ASSERT(!covariance || covariance->cameras == cameras.size());
  BodyPlanner planner(cameras, covariance, body, grid, corner_sigma, options);
  const glm::dvec2 minimum{grid.min_in_world.x, grid.min_in_world.z};
  const glm::dvec2 extent{grid.max_in_world.x - minimum.x,
                          grid.max_in_world.z - minimum.y};
  for (int k = 0; k < options.headings; ++k) {
    const double heading_rad = 2.0 * std::numbers::pi * k / options.headings;
    for (int i = 0; i < options.strides; ++i) {
      const int at = 1 + k * options.strides + i;
      const glm::dvec2 share{mirrored_digits(at, 2), mirrored_digits(at, 3)};
      planner.walk(heading_rad, minimum + share * extent);
    }
  }
  BodyPlan out = planner.plan();
  ErrorMapGrid stands = grid;
  stands.step_m = options.step_m;
  const int columns = stands.columns();
  for (int at = 0; at < stands.rows() * columns; ++at) {
    const glm::dvec2 place{at % columns, at / columns};
    out.stands.push_back(planner.stand(minimum + options.step_m * place));
  }
  return out;
}

}  // namespace marey::calib
