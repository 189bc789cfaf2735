// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/board.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/transform.h"

namespace marey::calib {

struct BoardCorner {
  glm::dvec3 p_in_board{0.0};  ///< [m]
  glm::dvec2 pixel_px{0.0};
  double sigma_px = 0.3;
};

/// The board as seen by one camera at one instant.
struct BoardView {
  CameraId camera{};
  int instant = 0;                   ///< Views of one instant share one board pose.
  std::vector<BoardCorner> corners;  ///< Four per tag, tags in ascending id order.
  bool of_tags = true;               ///< If false, each corner is an independent point.
};

/// The instant of every view of the board lying on the floor, where it is static. It
/// names an instant, not an absent value, and precedes the frame numbers of the waved
/// board.
inline constexpr int kFloorInstant = -1;

/// Returns the views of the board, ordered by camera and instant. A view of fewer than
/// `minimum_tags` tags, or of fewer than twice as many points of a board of squares, is
/// omitted: it does not determine the board's pose. A wand has no views.
///
/// `floor` may contain frames of the same recording as `waved`: a frame in both counts as
/// floor. Several floor frames of one camera become one view of averaged corners, since
/// neither board nor camera moves. A frame whose corners deviate from the median by more
/// than 3 px (for example, a foot on the board) is excluded from that average.
[[nodiscard]] std::vector<BoardView> board_views(std::span<const CameraDetections> waved,
                                                 std::span<const CameraDetections> floor,
                                                 const CalibrationTarget& board,
                                                 int minimum_tags = 3);

/// Returns the height of a board's face above the floor under it; 0 for a wand. [m]
[[nodiscard]] double thickness_m(const CalibrationTarget& board);

/// The lower left and upper right corners of the seen part of a board, in its frame [m].
struct BoardExtent {
  glm::dvec3 min_in_board{0.0};
  glm::dvec3 max_in_board{0.0};
};
[[nodiscard]] BoardExtent extent_of(const CalibrationTarget& board);

/// Returns the median distance [px] between the view's corners and their projections into
/// `camera` for a board at the given pose. A corner behind the camera counts as the image
/// width. Precondition: the view has a corner.
[[nodiscard]] double median_error_px(const BoardView& view,
                                     const Camera& camera,
                                     const RigidTransform& world_from_board);

}  // namespace marey::calib
