// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle_adjust.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <Eigen/Geometry>
#include <ceres/ceres.h>

#include "calib/camera_doubt.h"

namespace marey::calib {
namespace {

constexpr int kIntrinsics = Intrinsics::kParameterCount;

/// One tag of the board in one view.
struct TagResidual {
  LensModel lens = LensModel::kBrownConrady;
  std::array<BoardCorner, 4> corners;

  template <class T>
  bool operator()(const T* intrinsics,
                  const T* world_from_camera_xyzw,
                  const T* camera_in_world,
                  const T* world_from_board_xyzw,
                  const T* board_in_world,
                  const T* shrinkage,
                  T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> world_from_camera(
        world_from_camera_xyzw);
    const Eigen::Map<const Eigen::Quaternion<T>> world_from_board(world_from_board_xyzw);
    const Eigen::Map<const Vector> centre(camera_in_world);
    const Eigen::Map<const Vector> origin(board_in_world);
    std::array<std::array<T, 2>, 4> pixels{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const BoardCorner& corner = corners[i];
      const Vector p_in_board{
          T(corner.p_in_board.x), T(corner.p_in_board.y), T(corner.p_in_board.z)};
      const Vector p_in_world = world_from_board * p_in_board + origin;
      const Vector p_in_camera = world_from_camera.conjugate() * (p_in_world - centre);
      if (!project(lens, intrinsics, p_in_camera.data(), pixels[i].data())) return false;
    }
    move_edges(pixels, [&](const T& apart_px) {
      return T(apart_px - shrinkage[0] - shrinkage[1] * apart_px);
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      residual[2 * i] = (pixels[i][0] - corners[i].pixel_px.x) / corners[i].sigma_px;
      residual[2 * i + 1] = (pixels[i][1] - corners[i].pixel_px.y) / corners[i].sigma_px;
    }
    return true;
  }
};

/// What any camera is like before it is measured: square pixels, a centre near the
/// middle, modest distortion.
struct IntrinsicsPrior {
  double width_px;
  double height_px;

  template <class T>
  bool operator()(const T* k, T* residual) const {
    residual[0] = (k[0] - k[1]) / (T(0.002) * (k[0] + k[1]));
    residual[1] = (k[2] - T(0.5 * (width_px - 1))) / T(0.04 * width_px);
    residual[2] = (k[3] - T(0.5 * (height_px - 1))) / T(0.04 * width_px);
    residual[3] = k[4] / T(0.5);
    residual[4] = k[5] / T(0.3);
    residual[5] = k[6] / T(0.005);
    residual[6] = k[7] / T(0.005);
    residual[7] = k[8] / T(0.05);
    // Terms that the lens does not have: nothing else speaks of them.
    for (int i = 8; i < 11; ++i) residual[i] = k[i + 1] / T(0.1);
    return true;
  }
};

/// A tag shrinks by less than a pixel and by a few percent.
struct ShrinkagePrior {
  template <class T>
  bool operator()(const T* shrinkage, T* residual) const {
    residual[0] = shrinkage[0] / 0.5;
    residual[1] = shrinkage[1] / 0.02;
    return true;
  }
};

struct Blocks {
  std::vector<std::array<double, kIntrinsics>> intrinsics;
  std::vector<std::array<double, 2>> shrinkage;  ///< offset_px, slope
};

void add_views(std::span<const BoardView> views,
               Bundle& bundle,
               Blocks& blocks,
               ceres::Problem& problem) {
  for (const BoardView& view : views) {
    const auto board = bundle.world_from_board.find(view.instant);
    if (board == bundle.world_from_board.end()) continue;
    BundleCamera& camera = bundle.cameras[index(view.camera)];
    for (std::size_t first = 0; first + 3 < view.corners.size(); first += 4) {
      auto residual = std::make_unique<TagResidual>();
      residual->lens = camera.intrinsics.lens;
      std::copy_n(view.corners.begin() + static_cast<std::ptrdiff_t>(first),
                  4,
                  residual->corners.begin());
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<TagResidual, 8, kIntrinsics, 4, 3, 4, 3, 2>(
              residual.release()),
          // A tag block has eight residuals of unit variance: its norm is near 2.8.
          new ceres::CauchyLoss(5.0),
          blocks.intrinsics[index(view.camera)].data(),
          &camera.world_from_camera.rotation.x,
          &camera.world_from_camera.translation.x,
          &board->second.rotation.x,
          &board->second.translation.x,
          blocks.shrinkage[index(view.camera)].data());
    }
  }
}

void set_manifolds(Bundle& bundle, ceres::Problem& problem) {
  const auto is_used = [&](double* block) { return problem.HasParameterBlock(block); };
  for (BundleCamera& camera : bundle.cameras) {
    if (is_used(&camera.world_from_camera.rotation.x)) {
      problem.SetManifold(&camera.world_from_camera.rotation.x,
                          new ceres::EigenQuaternionManifold);
    }
  }
  for (auto& [instant, board] : bundle.world_from_board) {
    if (!is_used(&board.rotation.x)) continue;
    problem.SetManifold(&board.rotation.x, new ceres::EigenQuaternionManifold);
    if (instant == kFloorInstant) {
      problem.SetParameterBlockConstant(&board.rotation.x);
      problem.SetParameterBlockConstant(&board.translation.x);
    }
  }
}

bool fill_sigmas(Bundle& bundle, Blocks& blocks, ceres::Problem& problem) {
  std::vector<CameraBlocks> cameras;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    RigidTransform& world_from_camera = bundle.cameras[c].world_from_camera;
    // A camera without a view has no place to doubt.
    if (!problem.HasParameterBlock(&world_from_camera.rotation.x)) return false;
    cameras.push_back({blocks.intrinsics[c].data(),
                       &world_from_camera.rotation.x,
                       &world_from_camera.translation.x,
                       blocks.shrinkage[c].data()});
  }
  std::vector<BoardBlocks> boards;
  for (auto& [instant, board] : bundle.world_from_board) {
    const bool moves =
        instant != kFloorInstant && problem.HasParameterBlock(&board.rotation.x);
    if (moves) boards.push_back({&board.rotation.x, &board.translation.x});
  }
  const auto sigmas = camera_sigmas(cameras, boards, problem);
  if (!sigmas) return false;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    bundle.cameras[c].centre_sigma_m = (*sigmas)[c].centre_m;
    bundle.cameras[c].focal_sigma_px = (*sigmas)[c].focal_px;
  }
  return true;
}

}  // namespace

bool bundle_adjust(std::span<const BoardView> views, Bundle& bundle) {
  ceres::Problem problem;
  Blocks blocks;
  for (const BundleCamera& camera : bundle.cameras) {
    blocks.intrinsics.push_back(camera.intrinsics.parameters());
    blocks.shrinkage.push_back({camera.shrinkage.offset_px, camera.shrinkage.slope});
  }
  add_views(views, bundle, blocks, problem);
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const Intrinsics& k = bundle.cameras[c].intrinsics;
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<IntrinsicsPrior, 11, kIntrinsics>(
            new IntrinsicsPrior{static_cast<double>(k.width_px),
                                static_cast<double>(k.height_px)}),
        nullptr,
        blocks.intrinsics[c].data());
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<ShrinkagePrior, 2, 2>(new ShrinkagePrior),
        nullptr,
        blocks.shrinkage[c].data());
  }
  set_manifolds(bundle, problem);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // SuiteSparse calls whatever BLAS the machine has, whose order of summation may follow
  // where memory lies.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-9;
  options.num_threads = 1;  // One order of summation: the same bytes every time.
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    bundle.cameras[c].intrinsics.set_parameters(blocks.intrinsics[c]);
    bundle.cameras[c].shrinkage = {blocks.shrinkage[c][0], blocks.shrinkage[c][1]};
  }
  return fill_sigmas(bundle, blocks, problem);
}

}  // namespace marey::calib
