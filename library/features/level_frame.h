// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// The points of a body that are compared, in the order of the features.
enum class BodyPoint : int {
  kHips,
  kChest,
  kHead,
  kLeftElbow,
  kRightElbow,
  kLeftHand,
  kRightHand,
  kLeftKnee,
  kRightKnee,
  kLeftAnkle,
  kRightAnkle,
  kLeftToes,
  kRightToes,
};

inline constexpr int kBodyPointCount = 13;

[[nodiscard]] constexpr std::size_t index(BodyPoint point) {
  return static_cast<std::size_t>(point);
}

/// Returns the same point on the other side; the point itself in the middle of the body.
[[nodiscard]] BodyPoint mirrored(BodyPoint point);

/// Place of a point on a skeleton.
struct JointPoint {
  JointIndex joint{};
  glm::dvec3 p_in_joint{0.0};  ///< [m]
};

/// The points of one body, and the joints that determine its level frame.
struct BodyPoints {
  std::array<JointPoint, kBodyPointCount> points{};
  JointIndex hips{};
  glm::dquat t_pose_from_hips{1.0, 0.0, 0.0, 0.0};     ///< The canonical T-pose.
  std::array<JointIndex, 2> hip_joints{};              ///< Left, right.
  std::optional<std::array<JointIndex, 2>> shoulders;  ///< Left, right upper arm.
  double leg_length_m = 0.0;
};

/// Finds the points of a body. A missing bone is replaced:
/// - chest: upper chest, spine, else the hips;
/// - head: neck, upper chest, else the chest's point;
/// - elbow: upper arm, shoulder, else the chest's point;
/// - hand: the tip of the forearm if the skeleton states it, else the elbow's point;
/// - toes: the estimate of the body map (FootMap::ball_from_ankle_in_t_pose).
/// Shoulders are absent if an upper arm is missing on either side.
/// Precondition: `map` was made from the skeleton.
[[nodiscard]] BodyPoints find_body_points(const Skeleton& skeleton,
                                          const retarget::BodyMap& map);

/// Returns the position of a point in the world. [m]
[[nodiscard]] glm::dvec3 position(const BodyPoints& body,
                                  BodyPoint point,
                                  std::span<const RigidTransform> world_from_joint);

/// The level frame of a body: its origin is below the hips at world height 0, its axes
/// are `across` (level, from right to left), world up and `forward`. The coordinates of a
/// point are (across, up, forward), as (X, Y, Z) of a body that faces +Z.
struct LevelFrame {
  glm::dvec3 origin{0.0};             ///< In the world, Y = 0. [m]
  glm::dvec3 across{1.0, 0.0, 0.0};   ///< Unit, in the world.
  glm::dvec3 forward{0.0, 0.0, 1.0};  ///< Unit, in the world: across x up.

  /// Returns the coordinates of a point of the world. [m]
  [[nodiscard]] glm::dvec3 from_world(const glm::dvec3& p_in_world) const;
  /// Returns the components of a direction or a velocity of the world.
  [[nodiscard]] glm::dvec3 turn_from_world(const glm::dvec3& v_in_world) const;
  /// Angle of `forward` about Y, positive from +Z to +X. [rad]
  [[nodiscard]] double heading_rad() const;
};

/// Returns the level frame of a posture. `across` is the level part of (left minus right
/// upper arm) + (left minus right upper leg); without shoulders of the legs alone. If
/// this sum is vertical within 8.6 degrees (the body lies on its side), `forward` is the
/// level part of the hips' own forward axis, or of their up axis if that is vertical,
/// too. Constant time; allocates nothing.
[[nodiscard]] LevelFrame level_frame(const BodyPoints& body,
                                     std::span<const RigidTransform> world_from_joint);

/// Returns the turn from one frame to the next, -1.4 to 1.4, positive to the left. [rad]
/// A larger change (80 degrees) is no turn of the body, but a change of the direction
/// that the definition takes while the body lies: it counts as 0.
[[nodiscard]] double heading_change_rad(const LevelFrame& from, const LevelFrame& to);

}  // namespace marey::library
