// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/rig_normal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Sparse>
#include <ceres/ceres.h>

#include "calib/bundle/bundle_priors.h"
#include "calib/bundle/sighting_loss.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr int kLensColumns = Intrinsics::kParameterCount;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the root mean square of a sighting's coordinates, in sigmas; nullopt if its
/// target has no pose.
std::optional<double> whitened_error(const RigModel& model, const Sighting& sighting) {
  const std::vector<double> errors = errors_px(model, sighting);
  const double width_px = model.cameras[sighting.camera].intrinsics.width_px;
  if (errors.empty() ||
      *std::max_element(errors.begin(), errors.end()) > 0.1 * width_px) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double e = errors[i] / sighting.corners[i].sigma_px;
    sum += 0.5 * e * e;
  }
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

/// Returns the weights of all sightings' squares; 0 for sightings without a pose.
std::vector<double> weights_of(const RigModel& model) {
  std::vector<std::optional<double>> own(model.sightings.size());
  std::vector<std::vector<double>> by_camera(model.cameras.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    own[i] = whitened_error(model, model.sightings[i]);
    if (own[i]) by_camera[model.sightings[i].camera].push_back(*own[i]);
  }
  std::vector<double> usual(model.cameras.size(), 1.0);
  for (std::size_t c = 0; c < usual.size(); ++c) {
    if (!by_camera[c].empty()) usual[c] = std::max(1.0, median(std::move(by_camera[c])));
  }
  std::vector<double> weights(own.size(), 0.0);
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!own[i]) continue;
    const double scale = usual[model.sightings[i].camera];
    const double far = *own[i] / (kWeightScale * scale);
    weights[i] = 1.0 / (scale * scale * (1.0 + far * far));
  }
  return weights;
}

/// Accumulates one target, or one instant of it, and eliminates its poses.
class Group {
 public:
  explicit Group(int poses) : poses_(poses) {}

  void add(const SightingRows& rows, double weight, int first_pose) {
    const Eigen::MatrixXd weighted = weight * rows.pose;
    const Eigen::MatrixXd square = weighted.transpose() * rows.pose;
    const Eigen::MatrixXd mixed = weighted.transpose() * rows.shared;
    const int blocks = static_cast<int>(rows.pose.cols()) / 6;
    for (int a = 0; a < blocks; ++a) {
      for (int b = 0; b < blocks; ++b) {
        block(first_pose + a, first_pose + b) += square.block<6, 6>(6 * a, 6 * b);
      }
    }
    for (std::size_t k = 0; k < rows.columns.size(); ++k) {
      mixed_[used(rows.columns[k])].segment(6 * first_pose, mixed.rows()) +=
          mixed.col(static_cast<Eigen::Index>(k));
    }
    right_.segment(6 * first_pose, mixed.rows()) -= weighted.transpose() * rows.residual;
  }

  /// Adds to one coordinate of a pair of poses.
  void add_square(int a, int b, int coordinate, double value) {
    block(a, b)(coordinate, coordinate) += value;
  }
  void add_right(int pose, int coordinate, double value) {
    right_[6 * pose + coordinate] += value;
  }

  /// Eliminates the poses from `normal`, which contains the sightings. Returns false if
  /// the poses are not observable.
  [[nodiscard]] bool eliminate(RigNormal& normal) const {
    using Sparse = Eigen::SparseMatrix<double>;
    std::vector<Eigen::Triplet<double>> numbers;
    for (const auto& [place, values] : square_) {
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) {
          numbers.emplace_back(6 * place.first + i, 6 * place.second + k, values(i, k));
        }
      }
    }
    // Holds unobservable coordinates.
    for (int i = 0; i < 6 * poses_; ++i) numbers.emplace_back(i, i, 1e-9);
    Sparse square(6 * poses_, 6 * poses_);
    square.setFromTriplets(numbers.begin(), numbers.end());
    const auto columns = static_cast<Eigen::Index>(mixed_.size());
    Eigen::MatrixXd mixed(6 * poses_, columns);
    for (Eigen::Index k = 0; k < columns; ++k) {
      mixed.col(k) = mixed_[static_cast<std::size_t>(k)];
    }
    const Eigen::SimplicialLDLT<Sparse> factor(square);
    if (factor.info() != Eigen::Success) return false;
    const Eigen::MatrixXd solved = factor.solve(mixed);
    const Eigen::MatrixXd less = mixed.transpose() * solved;
    const Eigen::VectorXd less_right = solved.transpose() * right_;
    for (std::size_t i = 0; i < columns_of_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      normal.right[columns_of_[i]] -= less_right[row];
      for (std::size_t k = 0; k < columns_of_.size(); ++k) {
        normal.information(columns_of_[i], columns_of_[k]) -=
            less(row, static_cast<Eigen::Index>(k));
      }
    }
    return true;
  }

 private:
  using Block = Eigen::Matrix<double, 6, 6>;

  Block& block(int a, int b) {
    return square_.try_emplace({a, b}, Block::Zero()).first->second;
  }

  /// Only few columns take part.
  std::size_t used(int column) {
    const auto [found, is_new] = place_.try_emplace(column, columns_of_.size());
    if (is_new) {
      columns_of_.push_back(column);
      mixed_.emplace_back(Eigen::VectorXd::Zero(6 * poses_));
    }
    return found->second;
  }

  int poses_;
  std::map<std::pair<int, int>, Block> square_;  ///< By poses.
  std::vector<Eigen::VectorXd> mixed_;           ///< By columns_of_.
  Eigen::VectorXd right_ = Eigen::VectorXd::Zero(6 * poses_);
  std::map<int, std::size_t> place_;
  std::vector<int> columns_of_;
};

void add_block(const Eigen::MatrixXd& square,
               const Eigen::VectorXd& right,
               const std::vector<int>& columns,
               RigNormal& normal) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    normal.right[columns[i]] += right[row];
    for (std::size_t k = 0; k < columns.size(); ++k) {
      normal.information(columns[i], columns[k]) +=
          square(row, static_cast<Eigen::Index>(k));
    }
  }
}

/// Linearises a prior's residuals at these parameters.
template <class Prior, int kResiduals, int kNumbers>
void add_prior(Prior prior,
               const double* numbers,
               const std::vector<int>& columns,
               RigNormal& normal) {
  const ceres::AutoDiffCostFunction<Prior, kResiduals, kNumbers> cost(new Prior(prior));
  Eigen::VectorXd residual(kResiduals);
  RowMajor jacobian(kResiduals, kNumbers);
  double* pointer = jacobian.data();
  if (!cost.Evaluate(&numbers, residual.data(), &pointer)) return;
  const Eigen::MatrixXd of_columns =
      jacobian.leftCols(static_cast<Eigen::Index>(columns.size()));
  add_block(of_columns.transpose() * of_columns,
            -of_columns.transpose() * residual,
            columns,
            normal);
}

std::vector<int> from(int first, int count) {
  std::vector<int> columns;
  for (int i = 0; i < count; ++i) columns.push_back(first + i);
  return columns;
}

void add_priors(const RigModel& model, const RigColumns& columns, RigNormal& normal) {
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    const RigCamera& camera = model.cameras[c];
    const Intrinsics& k = camera.intrinsics;
    const auto lens = k.parameters();
    if (columns.lens(c) >= 0) {
      add_prior<LensPrior, LensPrior::kCount, kLensColumns>(
          {k.lens, static_cast<double>(k.width_px), static_cast<double>(k.height_px)},
          lens.data(),
          from(columns.lens(c), columns.lens_terms(c)),
          normal);
    }
    if (columns.shrinkage(c) >= 0) {
      const std::array<double, 2> shrinkage{camera.shrinkage.offset_px,
                                            camera.shrinkage.slope};
      add_prior<ShrinkagePrior, 2, 2>(
          {}, shrinkage.data(), from(columns.shrinkage(c), 2), normal);
    }
    // As in ClockPrior, where offsets have a sigma of ten seconds.
    const auto add_weight = [&](int column, double sigma, double value) {
      if (column < 0) return;
      normal.information(column, column) += 1.0 / (sigma * sigma);
      normal.right[column] -= value / (sigma * sigma);
    };
    add_weight(columns.offset(c), 10.0, camera.offset_s);
    add_weight(columns.drift(c), 3e-4, camera.drift);
    // Ten times the sigma of the prior, so that a hypothesis is not suppressed.
    add_weight(columns.line_delay(c), 5e-4, camera.line_delay_s);
    for (int i = 0; i < 6 * columns.windows(); ++i) {
      add_weight(columns.window(c, 0) + i, 1.0, 0.0);
    }
  }
  for (std::size_t t = 0; t < model.targets.size(); ++t) {
    for (std::size_t i = 0; i < model.targets[t].pieces.size(); ++i) {
      const int column = columns.piece(t, i);
      if (column < 0 || model.targets[t].same_board_as) continue;
      const bool is_size_known = model.targets[t].pieces[i].is_size_known;
      // An unobserved piece must not make the system singular.
      for (int k = 0; k < (is_size_known ? 6 : 7); ++k) {
        normal.information(column + k, column + k) += 1.0;
      }
    }
  }
}

/// Adds MotionPrior for a target's knots.
void add_motion_prior(const RigidTarget& target,
                      const RefineOptions& refine,
                      const std::map<int, int>& pose_of,
                      Group& group) {
  const double spacing_s = target.knot_spacing_s;
  const MotionPrior prior(refine.acceleration_m_s2 * spacing_s * spacing_s,
                          refine.acceleration_rad_s2 * spacing_s * spacing_s);
  for (const auto& [knot, place] : pose_of) {
    std::array<std::array<double, 7>, 3> blocks{};
    std::array<int, 3> first{};
    bool is_whole = true;
    for (int k = 0; k < 3 && is_whole; ++k) {
      const auto pose = target.world_from_target.find(knot - 1 + k);
      const auto at = pose_of.find(knot - 1 + k);
      is_whole = pose != target.world_from_target.end() && at != pose_of.end();
      if (!is_whole) break;
      blocks[static_cast<std::size_t>(k)] = pose_block(pose->second);
      first[static_cast<std::size_t>(k)] = at->second;
    }
    if (!is_whole) continue;
    const std::array<const double*, 3> numbers{
        blocks[0].data(), blocks[1].data(), blocks[2].data()};
    Eigen::Matrix<double, 6, 1> residual;
    std::array<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>, 3> jacobians;
    std::array<double*, 3> pointers{
        jacobians[0].data(), jacobians[1].data(), jacobians[2].data()};
    if (!prior.Evaluate(numbers.data(), residual.data(), pointers.data())) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      for (int i = 0; i < 6; ++i) {
        // Each residual depends only on its own coordinate.
        group.add_right(first[a], i, -jacobians[a](i, i) * residual[i]);
        for (std::size_t b = 0; b < 3; ++b) {
          group.add_square(
              first[a], first[b], i, jacobians[a](i, i) * jacobians[b](i, i));
        }
      }
    }
  }
}

}  // namespace

std::optional<RigNormal> rig_normal(const RigModel& model,
                                    const RigColumns& columns,
                                    const RefineOptions& refine,
                                    const RigRowOptions& options) {
  RigNormal normal{Eigen::MatrixXd::Zero(columns.all(), columns.all()),
                   Eigen::VectorXd::Zero(columns.all())};
  const std::vector<double> weights = weights_of(model);
  // The poses of targets with knots form one group; other targets have a group per
  // instant.
  std::map<std::pair<std::size_t, int>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < model.sightings.size(); ++i) {
    const Sighting& s = model.sightings[i];
    if (!(weights[i] > 0.0)) continue;
    const bool is_smooth = model.targets[s.target].knot_spacing_s > 0.0;
    groups[{s.target, is_smooth ? 0 : s.instant}].push_back(i);
  }
  for (const auto& [key, sightings] : groups) {
    const RigidTarget& target = model.targets[key.first];
    const bool is_smooth = target.knot_spacing_s > 0.0;
    std::map<int, int> pose_of;
    for (const auto& [knot, pose] : target.world_from_target) {
      if (is_smooth) pose_of.try_emplace(knot, static_cast<int>(pose_of.size()));
    }
    Group group(is_smooth ? static_cast<int>(pose_of.size()) : 1);
    for (const std::size_t i : sightings) {
      const auto rows = rows_of(model, columns, refine, options, model.sightings[i]);
      if (!rows) continue;
      add_block(weights[i] * rows->shared.transpose() * rows->shared,
                -weights[i] * rows->shared.transpose() * rows->residual,
                rows->columns,
                normal);
      if (target.stays) continue;
      group.add(*rows, weights[i], is_smooth ? pose_of.at(rows->first_knot) : 0);
    }
    if (target.stays) continue;
    if (is_smooth) add_motion_prior(target, refine, pose_of, group);
    if (!group.eliminate(normal)) return std::nullopt;
  }
  add_priors(model, columns, normal);
  return normal;
}

std::vector<std::vector<PixelsByPose>> pixels_by_pose(const RigModel& model,
                                                      const RigColumns& columns,
                                                      const RefineOptions& refine,
                                                      const RigRowOptions& options) {
  const auto windows = static_cast<std::size_t>(columns.windows());
  std::vector<std::vector<PixelsByPose>> out(
      model.cameras.size(), std::vector<PixelsByPose>(windows, PixelsByPose::Zero()));
  std::vector<std::vector<double>> counts(model.cameras.size(),
                                          std::vector<double>(windows, 0.0));
  for (const Sighting& s : model.sightings) {
    const int window = options.window_of ? options.window_of(s) : -1;
    if (window < 0 || !whitened_error(model, s)) continue;
    const auto rows = rows_of(model, columns, refine, options, s);
    if (!rows) continue;
    const auto w = static_cast<std::size_t>(window);
    for (int i = 0; i < s.count; ++i) {
      const Eigen::MatrixXd px = s.corners[static_cast<std::size_t>(i)].sigma_px *
                                 rows->camera.middleRows(2 * i, 2);
      out[s.camera][w] += px.transpose() * px;
      counts[s.camera][w] += 1.0;
    }
  }
  for (std::size_t c = 0; c < out.size(); ++c) {
    for (std::size_t w = 0; w < windows; ++w) {
      if (counts[c][w] > 0.0) out[c][w] /= counts[c][w];
    }
  }
  return out;
}

}  // namespace marey::calib
