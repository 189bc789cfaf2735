// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/board.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/ids.h"
#include "core/transform.h"

namespace marey::calib {

struct BoardCorner {
  glm::dvec3 p_in_board{0.0};  ///< [m]
  glm::dvec2 pixel_px{0.0};
  double sigma_px = 0.3;
};

/// The board as one camera sees it at one instant.
struct BoardView {
  CameraId camera{};
  int instant = 0;  ///< Views with one instant show the board in one place.
  std::vector<BoardCorner> corners;  ///< Four per tag, tags in ascending id order.
  bool of_tags = true;               ///< Otherwise each corner is a point of its own.
};

/// The instant of every view of the board lying on the floor: it does not move there.
inline constexpr int kFloorInstant = -1;

/// Views of the board, ordered by camera and instant. A view of fewer than `minimum_tags`
/// tags, or of fewer than twice as many points of a board of squares, is left out: too
/// little to place the board by. A wand is no board and has no views.
///
/// `floor` may be frames of the same recording as `waved`: a frame that is in both counts
/// as floor. Several floor frames of one camera become one view of averaged corners,
/// since neither board nor camera moves; a frame whose corners stray from the median by
/// more than 3 px (somebody's foot on the board) is left out of that average.
[[nodiscard]] std::vector<BoardView> board_views(std::span<const CameraDetections> waved,
                                                 std::span<const CameraDetections> floor,
                                                 const CalibrationTarget& board,
                                                 int minimum_tags = 3);

/// How far a board's face is above the floor it lies on; 0 for a wand. [m]
[[nodiscard]] double thickness_m(const CalibrationTarget& board);

/// The lower left and upper right ends of what is seen of a board, in its frame [m].
struct BoardExtent {
  glm::dvec3 least{0.0};
  glm::dvec3 greatest{0.0};
};
[[nodiscard]] BoardExtent extent_of(const CalibrationTarget& board);

/// Median distance between the view's corners and where `camera` would see them of a
/// board there, [px]. A corner behind the camera is as wrong as the picture is wide.
/// Precondition: the view has a corner.
[[nodiscard]] double median_error_px(const BoardView& view,
                                     const Camera& camera,
                                     const RigidTransform& world_from_board);

}  // namespace marey::calib
