// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/rig_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/model/sighting_cost.h"
#include "calib/model/spline_pose.h"
#include "calib/model/target_velocity.h"

namespace marey::calib {
namespace {

constexpr int kLensSize = Intrinsics::kParameterCount;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Evaluates SightingCost at a model's parameters.
class Evaluation {
 public:
  Evaluation(const RigModel& model, const Sighting& sighting, bool shrinks)
      : sighting_(sighting), target_(model.targets[sighting.target]) {
    const RigCamera& camera = model.cameras[sighting.camera];
    lens_ = camera.intrinsics.parameters();
    camera_ = pose_block(camera.world_from_camera);
    clock_ = {camera.offset_s, camera.drift, camera.line_delay_s};
    shrinkage_ = {camera.shrinkage.offset_px, camera.shrinkage.slope};
    parts_.spline = target_.knot_spacing_s > 0.0;
    parts_.shrinks = shrinks && sighting.count == 4;
    parts_.piece = !target_.pieces.empty();
    parts_.warp = target_.bends;
    if (parts_.spline) {
      knots_.spacing_s = target_.knot_spacing_s;
      const double time_s = sighting.time_s * (1.0 + camera.drift) + camera.offset_s;
      const int second = static_cast<int>(std::floor(time_s / knots_.spacing_s));
      knots_.first_s = second * knots_.spacing_s;
      first_knot_ = second - 1;
    }
    if (parts_.piece) {
      const Piece& piece = target_.pieces[sighting.piece];
      const PoseBlock pose = pose_block(piece.target_from_piece);
      std::copy(pose.begin(), pose.end(), piece_.begin());
      piece_[7] = std::log(piece.size_m);
    }
    lens_model_ = camera.intrinsics.lens;
    height_px_ = camera.intrinsics.height_px;
  }

  /// Returns false if a knot is missing or a corner is behind the camera.
  bool run() {
    std::vector<const double*> blocks{lens_.data(), camera_.data()};
    const int poses = parts_.spline ? 4 : 1;
    std::array<PoseBlock, 4> targets{};
    for (int k = 0; k < poses; ++k) {
      const int key = parts_.spline ? first_knot_ + k : sighting_.instant;
      const auto pose = target_.world_from_target.find(key);
      if (pose == target_.world_from_target.end()) return false;
      auto& block = targets[static_cast<std::size_t>(k)];
      block = pose_block(pose->second);
      blocks.push_back(block.data());
    }
    if (parts_.spline) blocks.push_back(clock_.data());
    if (parts_.shrinks) blocks.push_back(shrinkage_.data());
    if (parts_.piece) blocks.push_back(piece_.data());
    if (parts_.warp) blocks.push_back(target_.warp_m.data());
    const SightingCost cost(sighting_, target_, lens_model_, height_px_, parts_, knots_);
    residual.resize(cost.num_residuals());
    std::vector<double*> pointers;
    jacobians.clear();
    for (const int size : cost.parameter_block_sizes()) {
      jacobians.emplace_back(RowMajor::Zero(cost.num_residuals(), size));
    }
    for (RowMajor& jacobian : jacobians) pointers.push_back(jacobian.data());
    return cost.Evaluate(blocks.data(), residual.data(), pointers.data());
  }

  [[nodiscard]] const SightingCost::Parts& parts() const { return parts_; }
  [[nodiscard]] int first_knot() const { return first_knot_; }
  [[nodiscard]] int height_px() const { return height_px_; }

  Eigen::VectorXd residual;
  std::vector<RowMajor> jacobians;  ///< By block, in SightingCost's order.

 private:
  const Sighting& sighting_;
  const RigidTarget& target_;
  std::array<double, kLensSize> lens_{};
  PoseBlock camera_{};
  ClockBlock clock_{};
  std::array<double, 2> shrinkage_{};
  PieceBlock piece_{};
  SightingCost::Parts parts_;
  SightingCost::Knots knots_;
  int first_knot_ = 0;
  LensModel lens_model_ = LensModel::kBrownConrady;
  int height_px_ = 0;
};

/// Arranges blocks by their first columns.
class Gatherer {
 public:
  void add(int column, const Eigen::Ref<const Eigen::MatrixXd>& part) {
    if (column >= 0) parts_.emplace_back(column, part);
  }

  void into(SightingRows& out) const {
    Eigen::Index width = 0;
    for (const auto& [column, part] : parts_) width += part.cols();
    out.shared.resize(out.residual.size(), width);
    width = 0;
    for (const auto& [column, part] : parts_) {
      out.shared.middleCols(width, part.cols()) = part;
      width += part.cols();
      for (int i = 0; i < part.cols(); ++i) out.columns.push_back(column + i);
    }
  }

 private:
  std::vector<std::pair<int, Eigen::MatrixXd>> parts_;
};

/// Adds the derivative by time, for a target with a pose at every instant, from its
/// velocity.
void add_time(const RigModel& model,
              const RigColumns& columns,
              const Sighting& sighting,
              double rate_hz,
              const Eigen::MatrixXd& pose,
              Gatherer& out) {
  const RigidTarget& target = model.targets[sighting.target];
  if (target.stays) return;
  const auto velocity = velocity_at(target, sighting.instant, rate_hz);
  if (!velocity) return;
  Eigen::Matrix<double, 6, 1> step;
  step << velocity->turn_rad_s, velocity->move_m_s;
  const Eigen::VectorXd by_time = pose * step;
  Eigen::VectorXd by_row = by_time;
  const int height_px = model.cameras[sighting.camera].intrinsics.height_px;
  for (Eigen::Index i = 0; i < by_row.size(); ++i) {
    by_row[i] *= sighting.corners[static_cast<std::size_t>(i / 2)].pixel_px.y -
                 0.5 * (height_px - 1);
  }
  out.add(columns.offset(sighting.camera), by_time);
  out.add(columns.line_delay(sighting.camera), by_row);
}

}  // namespace

std::array<double, 7> pose_block(const RigidTransform& t) {
  return {t.rotation.x,
          t.rotation.y,
          t.rotation.z,
          t.rotation.w,
          t.translation.x,
          t.translation.y,
          t.translation.z};
}

std::optional<SightingRows> rows_of(const RigModel& model,
                                    const RigColumns& columns,
                                    const RefineOptions& refine,
                                    const RigRowOptions& options,
                                    const Sighting& sighting) {
  Evaluation at(model, sighting, refine.shrinkage);
  if (!at.run()) return std::nullopt;
  SightingRows out;
  out.residual = at.residual;
  out.first_knot = at.first_knot();
  out.camera = at.jacobians[1].leftCols(6);
  const std::size_t c = sighting.camera;
  Gatherer gathered;
  gathered.add(columns.lens(c), at.jacobians[0].leftCols(columns.lens_terms(c)));
  gathered.add(columns.pose(c), out.camera);
  const int window = options.window_of ? options.window_of(sighting) : -1;
  if (window >= 0) gathered.add(columns.window(c, window), out.camera);
  std::size_t next = 2;
  const int poses = at.parts().spline ? 4 : 1;
  out.pose.resize(at.residual.size(), 6 * poses);
  for (int k = 0; k < poses; ++k) {
    out.pose.middleCols(6 * k, 6) = at.jacobians[next++].leftCols(6);
  }
  if (at.parts().spline) {
    gathered.add(columns.offset(c), at.jacobians[next].col(0));
    gathered.add(columns.drift(c), at.jacobians[next].col(1));
    gathered.add(columns.line_delay(c), at.jacobians[next].col(2));
    ++next;
  } else {
    add_time(model, columns, sighting, options.rate_hz, out.pose, gathered);
  }
  if (at.parts().shrinks) gathered.add(columns.shrinkage(c), at.jacobians[next++]);
  if (at.parts().piece) {
    const RigidTarget& target = model.targets[sighting.target];
    const int size = target.pieces[sighting.piece].is_size_known ? 6 : 7;
    gathered.add(columns.piece(sighting.target, sighting.piece),
                 at.jacobians[next++].leftCols(size));
  }
  gathered.into(out);
  return out;
}

}  // namespace marey::calib
