// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: cameras, targets and sightings as the joint refinement moves them.

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calib/board_views.h"
#include "calib/expected_error.h"
#include "core/camera.h"
#include "core/ids.h"

namespace marey::calib {

/// A tag on a rigid body; or a board of known layout, which is one piece of size 1.
struct Piece {
  TagId id{};
  RigidTransform target_from_piece;
  double size_m = 1.0;  ///< Edge of its black square.
  bool is_size_known = true;
  bool is_placed = true;  ///< Where it is on the target is known by now.
};

/// Something rigid that cameras see: a board, a wand, the scenery.
struct RigidTarget {
  /// Tags whose places on the target are solved for. Empty: corners say where they are.
  std::vector<Piece> pieces;
  bool stays = false;  ///< It does not move, nor is its pose solved for.
  bool bends = false;  ///< Its warp is solved for.
  /// How far a board rises out of its plane towards its edges along x and y, and its
  /// corners across [m]; its middle stays (board_warp()).
  std::array<double, 3> warp_m{};
  /// The earlier target that is the same board or wand: they bend alike, and their
  /// pieces, which are the same in number and order, sit alike.
  std::optional<std::size_t> same_board_as;
  glm::dvec3 middle_in_target{0.0};  ///< Of a board that bends.
  glm::dvec3 half_extent_m{1.0};     ///< Likewise.
  /// Where it is, per instant; instant 0 alone when it stays.
  std::map<int, RigidTransform> world_from_target;
  /// Spacing of the knots when it moves smoothly: then `world_from_target` has knots by
  /// number, and instants mean nothing. 0: it has a pose of its own at every instant.
  double knot_spacing_s = 0.0;
};

/// Whether it is what the cameras are calibrated with, and not the scenery about it.
[[nodiscard]] inline bool is_shown(const RigidTarget& target) {
  return !target.stays || target.pieces.empty();
}

/// What one frame of one camera shows of one tag (four corners) or one point (one).
struct Sighting {
  std::size_t camera = 0;
  std::size_t target = 0;
  int instant = 0;        ///< Of the target; frames of one instant are simultaneous.
  int frame = 0;          ///< Of the recording, for messages.
  double time_s = 0.0;    ///< On the camera's own clock.
  std::size_t piece = 0;  ///< Of a target that has pieces.
  std::array<BoardCorner, 4> corners;  ///< In the target, or in the piece (size 1).
  int count = 4;                       ///< Corners that are there: 1 or 4.
  bool is_outlier = false;             ///< Left out of the last refinement.
};

struct RigCamera {
  Intrinsics intrinsics;
  RigidTransform world_from_camera;
  TagShrinkage shrinkage;
  double offset_s = 0.0;      ///< A frame at time t of its own was taken at t + offset...
  double drift = 0.0;         ///< ...+ drift * t.
  double line_delay_s = 0.0;  ///< From one image row to the next.
};

struct RigModel {
  std::vector<RigCamera> cameras;
  std::vector<RigidTarget> targets;
  std::vector<Sighting> sightings;
};

/// The unit square of a tag: corner_in_tag() of size 1, pixels of the detection.
[[nodiscard]] Sighting sighting_of(const TagDetection& tag);

/// Where a corner of a sighting is in the target.
[[nodiscard]] glm::dvec3 corner_in_target(const RigidTarget& target,
                                          const Sighting& sighting,
                                          int corner);

/// The target's pose as that sighting's camera met it; nullopt where it is not known.
[[nodiscard]] std::optional<RigidTransform> world_from_target(const RigModel& model,
                                                              const Sighting& sighting);

/// Camera `c` as others know it.
[[nodiscard]] Camera camera_of(const RigCamera& camera, std::string name = {});

/// Distances [px] of a sighting's corners from where the model has them, shrinkage taken
/// off. Empty where it has no pose; as wrong as the picture is wide behind the camera.
[[nodiscard]] std::vector<double> errors_px(const RigModel& model,
                                            const Sighting& sighting);

}  // namespace marey::calib
