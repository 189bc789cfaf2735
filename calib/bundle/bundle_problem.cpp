// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_problem.h"

#include <cmath>

#include <Eigen/Dense>

#include "calib/bundle/bundle_priors.h"
#include "calib/bundle/rig_rows.h"
#include "calib/bundle/sighting_loss.h"

namespace marey::calib {
namespace {

constexpr int kLens = Intrinsics::kParameterCount;

template <class Block>
RigidTransform to_transform(const Block& b) {
  return {{b[3], b[0], b[1], b[2]}, {b[4], b[5], b[6]}};
}

/// Calls a function after each iteration.
class IterationReport : public ceres::IterationCallback {
 public:
  explicit IterationReport(const std::function<void()>& report) : report_(report) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    if (report_) report_();
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<void()>& report_;
};

}  // namespace

BundleProblem::BundleProblem(const RigModel& model,
                             const RefineOptions& options,
                             bool robust)
    // The robust pass only provides the start of the other.
    : shrinks_(options.shrinkage),
      tolerance_(robust || options.quick ? 1e-6 : 1e-9),
      max_iterations_(options.quick ? 40 : 100),
      on_iteration_(options.on_iteration) {
  for (const RigCamera& camera : model.cameras) {
    CameraBlock block;
    block.lens = camera.intrinsics.parameters();
    block.pose = pose_block(camera.world_from_camera);
    block.clock = {camera.offset_s, camera.drift, camera.line_delay_s};
    block.shrinkage = {camera.shrinkage.offset_px, camera.shrinkage.slope};
    cameras_.push_back(block);
  }
  for (const RigidTarget& target : model.targets) {
    TargetBlock block;
    for (const auto& [instant, pose] : target.world_from_target) {
      block.poses[instant] = pose_block(pose);
    }
    for (const Piece& piece : target.pieces) {
      const PoseBlock pose = pose_block(piece.target_from_piece);
      PieceBlock numbers{};
      std::copy(pose.begin(), pose.end(), numbers.begin());
      numbers[7] = std::log(piece.size_m);
      block.pieces.push_back(numbers);
    }
    block.warp = target.warp_m;
    targets_.push_back(std::move(block));
  }
  for (const Sighting& sighting : model.sightings) {
    if (!sighting.is_outlier) add_sighting(model, sighting, robust);
  }
  add_motion_priors(model, options);
  set_manifolds(model, options);
  set_clocks(model, options);
  // Only for free parameters: the cost of the prior of a held lens is irrelevant.
  add_priors(model);
}

void BundleProblem::add_sighting(const RigModel& model,
                                 const Sighting& sighting,
                                 bool robust) {
  const RigidTarget& target = model.targets[sighting.target];
  const Intrinsics& intrinsics = model.cameras[sighting.camera].intrinsics;
  CameraBlock& camera = cameras_[sighting.camera];
  TargetBlock& blocks = targets_[sighting.target];
  SightingCost::Parts parts;
  parts.spline = target.knot_spacing_s > 0.0;
  parts.shrinks = shrinks_ && sighting.count == 4;
  parts.piece = !target.pieces.empty();
  parts.warp = target.bends;
  SightingCost::Knots knots;
  std::vector<double*> parameters{camera.lens.data(), camera.pose.data()};
  int first = sighting.instant;
  if (parts.spline) {
    knots.spacing_s = target.knot_spacing_s;
    const double time_s = sighting.time_s * (1.0 + camera.clock[1]) + camera.clock[0];
    const int second = static_cast<int>(std::floor(time_s / knots.spacing_s));
    knots.first_s = second * knots.spacing_s;
    first = second - 1;
  }
  for (int k = 0; k < (parts.spline ? 4 : 1); ++k) {
    const auto pose = blocks.poses.find(first + k);
    if (pose == blocks.poses.end()) return;
    parameters.push_back(pose->second.data());
  }
  if (parts.spline) parameters.push_back(camera.clock.data());
  if (parts.shrinks) parameters.push_back(camera.shrinkage.data());
  const std::size_t same = target.same_board_as.value_or(sighting.target);
  if (parts.piece) parameters.push_back(targets_[same].pieces[sighting.piece].data());
  if (parts.warp) parameters.push_back(targets_[same].warp.data());
  ceres::LossFunction* loss = nullptr;
  if (sighting.count == 4) {
    loss = new ceres::CauchyLoss(kTagLossSigmas);
  } else if (robust) {
    loss = new ceres::CauchyLoss(kPointLossSigmas);
  }
  problem_.AddResidualBlock(
      new SightingCost(
          sighting, target, intrinsics.lens, intrinsics.height_px, parts, knots),
      loss,
      parameters);
  residuals_ += 2 * sighting.count;
}

void BundleProblem::add_priors(const RigModel& model) {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const Intrinsics& k = model.cameras[c].intrinsics;
    if (moves(cameras_[c].lens.data())) {
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LensPrior, LensPrior::kCount, kLens>(
              new LensPrior{k.lens,
                            static_cast<double>(k.width_px),
                            static_cast<double>(k.height_px)}),
          nullptr,
          cameras_[c].lens.data());
    }
    if (moves(cameras_[c].shrinkage.data())) {
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ShrinkagePrior, 2, 2>(new ShrinkagePrior),
          nullptr,
          cameras_[c].shrinkage.data());
    }
    if (moves(cameras_[c].clock.data())) {
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ClockPrior, 3, 3>(new ClockPrior),
          nullptr,
          cameras_[c].clock.data());
    }
  }
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    for (std::size_t i = 0; i < targets_[t].pieces.size(); ++i) {
      double* piece = targets_[t].pieces[i].data();
      if (model.targets[t].pieces[i].is_size_known || !moves(piece)) continue;
      problem_.AddResidualBlock(new SizePrior(piece[7]), nullptr, piece);
    }
    if (moves(targets_[t].warp.data())) {
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<WarpPrior, 3, 3>(new WarpPrior),
          nullptr,
          targets_[t].warp.data());
    }
  }
}

void BundleProblem::add_motion_priors(const RigModel& model,
                                      const RefineOptions& options) {
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const double spacing_s = model.targets[t].knot_spacing_s;
    if (spacing_s <= 0.0) continue;
    auto& poses = targets_[t].poses;
    for (auto& [knot, pose] : poses) {
      const auto before = poses.find(knot - 1);
      const auto after = poses.find(knot + 1);
      if (before == poses.end() || after == poses.end()) continue;
      problem_.AddResidualBlock(
          new MotionPrior(options.acceleration_m_s2 * spacing_s * spacing_s,
                          options.acceleration_rad_s2 * spacing_s * spacing_s),
          nullptr,
          before->second.data(),
          pose.data(),
          after->second.data());
    }
  }
}

bool BundleProblem::moves(const double* block) const {
  return problem_.HasParameterBlock(block) && !problem_.IsParameterBlockConstant(block);
}

void BundleProblem::set_manifolds(const RigModel& model, const RefineOptions& options) {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    CameraBlock& camera = cameras_[c];
    if (!problem_.HasParameterBlock(camera.pose.data())) continue;
    problem_.SetManifold(camera.pose.data(), new PoseManifold);
    if (!options.camera_poses || options.fixed_camera == c) {
      problem_.SetParameterBlockConstant(camera.pose.data());
    }
    const bool is_held = c < options.held_lenses.size() && options.held_lenses[c];
    if (!options.intrinsics || is_held) {
      problem_.SetParameterBlockConstant(camera.lens.data());
    }
  }
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const RigidTarget& target = model.targets[t];
    for (auto& [instant, pose] : targets_[t].poses) {
      if (!problem_.HasParameterBlock(pose.data())) continue;
      problem_.SetManifold(pose.data(), new PoseManifold);
      if (target.stays) problem_.SetParameterBlockConstant(pose.data());
    }
    for (std::size_t i = 0; i < targets_[t].pieces.size(); ++i) {
      double* block = targets_[t].pieces[i].data();
      if (!problem_.HasParameterBlock(block)) continue;
      const bool is_size_known = target.pieces[i].is_size_known;
      if (!target.stays && i == 0) {
        // The first piece is the target's own frame.
        if (is_size_known) {
          problem_.SetParameterBlockConstant(block);
        } else {
          problem_.SetManifold(block, new SizeManifold);
        }
      } else {
        problem_.SetManifold(block, new PoseManifold(8, is_size_known ? 6 : 7));
      }
    }
  }
}

void BundleProblem::set_clocks(const RigModel& model, const RefineOptions& options) {
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    double* clock = cameras_[c].clock.data();
    if (!problem_.HasParameterBlock(clock)) continue;
    std::vector<int> fixed;
    // The first camera's clock is the reference.
    if (!options.offsets || c == 0) fixed.push_back(0);
    if (!options.drifts || c == 0) fixed.push_back(1);
    if (!options.line_delays) fixed.push_back(2);
    if (fixed.size() == 3) {
      problem_.SetParameterBlockConstant(clock);
    } else if (!fixed.empty()) {
      problem_.SetManifold(clock, new ceres::SubsetManifold(3, fixed));
    }
  }
}

bool BundleProblem::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // SuiteSparse calls the installed BLAS, whose order of summation may depend on memory
  // alignment.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = max_iterations_;
  options.function_tolerance = tolerance_;
  options.num_threads = 1;  // A fixed order of summation: bit-identical results.
  options.logging_type = ceres::SILENT;
  IterationReport report(on_iteration_);
  options.callbacks.push_back(&report);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  return summary.IsSolutionUsable();
}

void BundleProblem::write_back(RigModel& model) const {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const CameraBlock& block = cameras_[c];
    RigCamera& camera = model.cameras[c];
    camera.intrinsics.set_parameters(block.lens);
    camera.world_from_camera = to_transform(block.pose);
    camera.offset_s = block.clock[0];
    camera.drift = block.clock[1];
    camera.line_delay_s = block.clock[2];
    camera.shrinkage = {block.shrinkage[0], block.shrinkage[1]};
  }
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    RigidTarget& target = model.targets[t];
    for (const auto& [instant, pose] : targets_[t].poses) {
      target.world_from_target[instant] = to_transform(pose);
    }
    const TargetBlock& same = targets_[target.same_board_as.value_or(t)];
    for (std::size_t i = 0; i < target.pieces.size(); ++i) {
      const PieceBlock& block = same.pieces[i];
      target.pieces[i].target_from_piece = to_transform(block);
      if (!target.pieces[i].is_size_known) target.pieces[i].size_m = std::exp(block[7]);
    }
    target.warp_m = same.warp;
  }
}

}  // namespace marey::calib
