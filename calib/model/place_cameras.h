// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/model/board_views.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/camera.h"

namespace marey::calib {

/// Poses of cameras and board in one frame, before bundle adjustment.
struct RigGuess {
  std::vector<RigidTransform> camera_from_world;   ///< Per camera.
  std::map<int, RigidTransform> world_from_board;  ///< Per instant.
};

/// Returns the pose of the board in the world while it lies on the floor. The world's
/// origin is the board's own origin on the floor, X along its x, Y up, Z = -(board y).
[[nodiscard]] RigidTransform world_from_floor_board(const CalibrationTarget& board);

/// Places cameras relative to each other through the instants at which two of them see
/// the board, along the spanning tree of the most shared instants, then in the world
/// through the floor views.
///
/// The relative pose of a pair is the one that most shared instants agree with. A few
/// wrong planar solutions therefore have no effect.
/// Without `needs_floor`, and if no camera sees the board on the floor, the world's
/// origin is the first camera's centre, X its right, Y its up.
/// Errors (kBadInput, `where` empty): cameras that no shared sighting connects, naming
/// the groups; no floor view. Preconditions: intrinsics and names per camera; views in
/// the order of board_views().
[[nodiscard]] Result<RigGuess> place_cameras(std::span<const BoardView> views,
                                             std::span<const Intrinsics> intrinsics,
                                             std::span<const std::string> names,
                                             const CalibrationTarget& board,
                                             bool needs_floor = true);

/// Returns the default world of a rig without a floor: the camera's centre is the origin,
/// X its right, Y its up.
[[nodiscard]] RigidTransform world_from_upright_camera();

}  // namespace marey::calib
