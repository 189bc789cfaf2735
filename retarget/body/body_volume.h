// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// The parts of a body that touch each other. Left limbs before right ones.
enum class VolumePart : int {
  kHead,
  kChest,
  kAbdomen,
  kPelvis,
  kLeftUpperArm,
  kLeftForearm,
  kLeftHand,
  kLeftThigh,
  kLeftShank,
  kRightUpperArm,
  kRightForearm,
  kRightHand,
  kRightThigh,
  kRightShank,
};

inline constexpr int kVolumePartCount = 14;

[[nodiscard]] constexpr std::size_t index(VolumePart part) {
  return static_cast<std::size_t>(part);
}

/// Returns the part's name in messages: "left thigh".
[[nodiscard]] std::string_view name(VolumePart part);

/// Returns the same limb's part on a side, 0 left and 1 right.
/// Precondition: a left limb's part.
[[nodiscard]] constexpr VolumePart on_side(VolumePart left_part, int side) {
  return static_cast<VolumePart>(static_cast<int>(left_part) + 5 * side);
}

/// All points within a radius of a line segment. The frame's origin is the middle of the
/// segment, Z points along it, and X towards the front of the body in its T-pose, so that
/// directions about it mean the same on every body.
struct Capsule {
  JointIndex joint{};  ///< The joint that carries it.
  RigidTransform joint_from_capsule;
  double half_length_m = 0.0;  ///< Half the line's length; 0 is a ball.
  double radius_m = 0.0;
};

/// The volume of a body, by parts. A limb's capsule lies along its bone, from its root to
/// its end. The trunk's three capsules lie across, left to right, because a trunk is half
/// again as broad as it is deep.
struct BodyVolume {
  std::array<std::optional<Capsule>, kVolumePartCount> parts{};
  /// The outermost points of the hands' skin, left and right, each in its joint's frame;
  /// empty: their capsules' surface.
  std::array<std::vector<glm::dvec3>, 2> hand_skin_in_joint;

  [[nodiscard]] const std::optional<Capsule>& operator[](VolumePart part) const {
    return parts[index(part)];
  }
  [[nodiscard]] std::optional<Capsule>& operator[](VolumePart part) {
    return parts[index(part)];
  }
};

/// Position of a point relative to a capsule.
struct CapsuleSide {
  double distance_m = 0.0;  ///< From the surface; negative within.
  glm::dvec3 outward{0.0};  ///< Unit, from the axis to the point; the front on the axis.
};

/// Computes it in the capsule's frame. Exact, allocates nothing.
[[nodiscard]] CapsuleSide side_of(const Capsule& capsule, const glm::dvec3& p_in_capsule);

/// Returns the world Y of a hand's lowest point. [m]
/// Precondition: the body has that hand; world_from_hand is of its joint.
[[nodiscard]] double lowest_m(const BodyVolume& volume,
                              int side,
                              const RigidTransform& world_from_hand);

/// Computes it in the world.
/// Precondition: one frame per joint.
[[nodiscard]] CapsuleSide side_of(const Capsule& capsule,
                                  std::span<const RigidTransform> world_from_joint,
                                  const glm::dvec3& p_in_world);

/// Returns the point of the axis, -1 at its start to 1 at its end, in the joint's frame.
[[nodiscard]] glm::dvec3 axis_point_in_joint(const Capsule& capsule, double along);

/// Maps a ball next to capsule `from` to `to`: to the same place on it, measured in its
/// lengths and radii, with the same distance between the surfaces. On a capsule of the
/// same size the place is the same, to rounding. Continuous; smooth except where a
/// capsule's side meets its end. Both points are in their capsule's frame.
[[nodiscard]] glm::dvec3 carried_over(const Capsule& from,
                                      const glm::dvec3& p_in_from,
                                      double ball_at_from_m,
                                      const Capsule& to,
                                      double ball_at_to_m);

/// A place on the surface of a part, independent of its size.
struct PlaceOnPart {
  double along = 0.0;       ///< -1 to 1 from end to end, caps included.
  double around_rad = 0.0;  ///< About the axis from the front, counterclockwise.
};

/// Returns the surface place of a point in the capsule's frame, outside or inside.
[[nodiscard]] PlaceOnPart place_on(const Capsule& capsule,
                                   const glm::dvec3& p_in_capsule);

/// Returns the point of the surface, in the joint's frame.
[[nodiscard]] glm::dvec3 surface_point_in_joint(const Capsule& capsule,
                                                const PlaceOnPart& place);

/// Returns the volume of an average adult with this skeleton's lengths. Ratios: thickness
/// to length of the same segment; breadth of the trunk to that between shoulders and
/// hips; its depth to its height. They come from the girths, breadths and depths in
/// Gordon et al. 2014, "2012 Anthropometric Survey of U.S. Army Personnel"
/// (NATICK/TR-15/007), means of women and men to a centimetre, over the segments of
/// average_proportions(). Cross sections are assumed to be round; a hand's radius lies
/// between half its thickness and half its breadth. A skeleton does not contain the
/// actual thickness; a mesh does (retarget/body/volume_of_skin.h). Parts whose bones the
/// skeleton lacks are absent.
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] BodyVolume average_volume(const Skeleton& skeleton, const BodyMap& map);

/// Returns the joint frames in the canonical T-pose, with positions relative to the first
/// joint's rest position.
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] std::vector<RigidTransform> t_pose_joints(const Skeleton& skeleton,
                                                        const BodyMap& map);

}  // namespace marey::retarget
