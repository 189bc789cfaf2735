// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: how well a bundle's cameras are known.

#include <optional>
#include <span>
#include <vector>

#include <ceres/ceres.h>

namespace marey::calib {

/// One camera's parameter blocks in the problem.
struct CameraBlocks {
  double* intrinsics = nullptr;  ///< Intrinsics::parameters(): fx, fy first.
  double* world_from_camera_xyzw = nullptr;
  double* camera_in_world = nullptr;
  double* shrinkage = nullptr;
};

/// One board's parameter blocks, of a board that the problem moves.
struct BoardBlocks {
  double* world_from_board_xyzw = nullptr;
  double* board_in_world = nullptr;
};

struct CameraSigmas {
  double centre_m = 0.0;  ///< Root mean square over the three coordinates.
  double focal_px = 0.0;  ///< Root mean square over fx and fy.
};

/// Standard deviations from the inverse of the problem's normal matrix, where the boards
/// (block-diagonal: none depends on another) are eliminated first by their Schur
/// complement. Same bytes every time: one thread, one order of summation, which Ceres'
/// own covariance through the parallel sparse QR does not promise.
///
/// nullopt when the problem cannot be evaluated or leaves a camera free to move.
/// Cost: linear in boards, cubic in cameras. Precondition: every block is in the problem,
/// none constant.
[[nodiscard]] std::optional<std::vector<CameraSigmas>> camera_sigmas(
    std::span<const CameraBlocks> cameras,
    std::span<const BoardBlocks> boards,
    ceres::Problem& problem);

}  // namespace marey::calib
