// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: cameras, targets and sightings of the joint refinement.

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calib/model/board_views.h"
#include "calib/model/expected_error.h"
#include "core/base/ids.h"
#include "core/camera.h"

namespace marey::calib {

/// A tag on a rigid target whose layout is not known: a wand, or static tags. Boards have
/// a known layout and no pieces.
struct Piece {
  TagId id{};
  RigidTransform target_from_piece;
  double size_m = 1.0;        ///< Edge of its black square. [m]
  bool is_size_known = true;  ///< False: `size_m` is estimated.
  bool is_placed = true;      ///< False until the pose on the target is estimated.
};

/// A rigid object that cameras see: a board, a wand, or the static tags of the scene.
struct RigidTarget {
  /// Tags whose poses on the target are solved for. Empty: corners have known positions.
  std::vector<Piece> pieces;
  bool stays = false;  ///< Static; its pose is not solved for.
  bool bends = false;  ///< Its warp is solved for.
  /// Rise of a board out of its plane towards its edges along x and y, and its twist [m];
  /// the board's middle does not move (board_warp()).
  std::array<double, 3> warp_m{};
  /// Earlier target that is the same board or wand: both share one warp, and their
  /// pieces, equal in number and order, share their poses on the target.
  std::optional<std::size_t> same_board_as;
  glm::dvec3 middle_in_target{0.0};  ///< For a board that bends.
  glm::dvec3 half_extent_m{1.0};     ///< For a board that bends.
  /// Pose per instant; a static target has instant 0 alone.
  std::map<int, RigidTransform> world_from_target;
  /// Spacing of the knots of a smooth motion: `world_from_target` then has knots by
  /// number, and instants have no meaning. 0: a separate pose at every instant.
  double knot_spacing_s = 0.0;
};

/// Returns true if the target is the board or wand of the calibration, false for static
/// tags of the scene.
[[nodiscard]] inline bool is_calibration_target(const RigidTarget& target) {
  return !target.stays || target.pieces.empty();
}

/// One tag (four corners) or one point (one corner) in one frame of one camera.
struct Sighting {
  std::size_t camera = 0;
  std::size_t target = 0;
  int instant = 0;  ///< Instant of the target; frames of one instant are simultaneous.
  int frame = 0;    ///< Frame of the recording, for messages.
  double time_s = 0.0;                 ///< On the camera's own clock.
  std::size_t piece = 0;               ///< Index, for targets with pieces.
  std::array<BoardCorner, 4> corners;  ///< In the target, or in the piece (size 1).
  int count = 4;                       ///< Number of valid corners: 1 or 4.
  bool is_outlier = false;             ///< Excluded from the last refinement.
};

struct RigCamera {
  Intrinsics intrinsics;
  RigidTransform world_from_camera;
  TagShrinkage shrinkage;
  double offset_s = 0.0;  ///< A frame at time t of this clock was taken at t + offset...
  double drift = 0.0;     ///< ...+ drift * t.
  double line_delay_s = 0.0;  ///< From one image row to the next.
};

struct RigModel {
  std::vector<RigCamera> cameras;
  std::vector<RigidTarget> targets;
  std::vector<Sighting> sightings;
};

/// Returns the sighting of a tag: corner_in_tag() of size 1, pixels of the detection.
[[nodiscard]] Sighting sighting_of(const TagDetection& tag);

/// Returns the coefficients of warp_m in the z of a point of a board: the squares and the
/// product of its distances from the middle, in half extents.
[[nodiscard]] std::array<double, 3> board_warp(const RigidTarget& target,
                                               const glm::dvec3& p_in_target);

/// Returns the position of a sighting's corner in the target.
[[nodiscard]] glm::dvec3 corner_in_target(const RigidTarget& target,
                                          const Sighting& sighting,
                                          int corner);

/// Returns the target's pose at the time of the sighting; nullopt if it is not known.
[[nodiscard]] std::optional<RigidTransform> world_from_target(const RigModel& model,
                                                              const Sighting& sighting);

/// Returns camera `c` as a public Camera.
[[nodiscard]] Camera camera_of(const RigCamera& camera, std::string name = {});

/// Returns the distances [px] of a sighting's corners from their projections, with
/// shrinkage corrected. Returns none if the target has no pose; a corner behind the
/// camera counts as the image width.
[[nodiscard]] std::vector<double> errors_px(const RigModel& model,
                                            const Sighting& sighting);

}  // namespace marey::calib
