// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/board_views.h"
#include "core/board.h"
#include "core/camera.h"
#include "core/result.h"

namespace marey::calib {

/// Cameras and board in one frame, before bundle adjustment.
struct RigGuess {
  std::vector<RigidTransform> camera_from_world;   ///< Per camera.
  std::map<int, RigidTransform> world_from_board;  ///< Per instant.
};

/// The pose of the board in the world while it lies on the floor. The world's origin is
/// the board's own origin on the floor, X along its x, Y up, Z = -(board y).
[[nodiscard]] RigidTransform world_from_floor_board(const CalibrationTarget& board);

/// Places cameras relative to each other through the instants at which two of them see
/// the board, along the spanning tree of most shared instants, then in the world through
/// the floor views.
///
/// Per pair, the relative pose is the one that most shared instants agree with, so that a
/// few wrong planar solutions do no harm.
/// Without `needs_floor`, and where no camera sees the board lie there, the world is the
/// first camera's: its place the origin, its right X, its up Y.
/// Errors (kBadInput, `where` empty): cameras that no shared sighting connects, naming
/// the groups; no floor view. Precondition: intrinsics and names per camera; views
/// ordered as board_views() does.
[[nodiscard]] Result<RigGuess> place_cameras(std::span<const BoardView> views,
                                             std::span<const Intrinsics> intrinsics,
                                             std::span<const std::string> names,
                                             const CalibrationTarget& board,
                                             bool needs_floor = true);

/// The world of whom nothing else tells: the camera's place is the origin, its right X,
/// its up Y.
[[nodiscard]] RigidTransform world_from_upright_camera();

}  // namespace marey::calib
