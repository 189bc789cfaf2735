// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "live/vmc/osc_writer.h"

namespace marey::live {

/// Where VRChat listens for trackers.
inline constexpr int kVrchatPort = 9000;

struct VrchatTrackersOptions {
  /// World rotation of each joint's frame in the T-pose, as Character::t_pose_from_joint;
  /// empty when the rest pose is one. Read by the constructor alone.
  std::span<const glm::dquat> t_pose_from_joint = {};
  bool knees = true;
  bool elbows = true;
  bool chest = true;
  /// Also tells where the head is, by which VRChat moves all trackers to the headset's
  /// place: off when the world is the headset's already.
  bool head = true;
};

/// A body's trackers for VRChat (docs.vrchat.com/docs/osc-trackers): a bundle of
/// /tracking/trackers/N/position and /rotation, three floats each.
///
///     1 hip, 2 chest, 3 and 4 feet, 5 and 6 knees, 7 and 8 elbows, left before right
///
/// Numbers stay the same whichever are sent. Positions are joints' centres in Unity's
/// world, left-handed, Y up [m]; rotations are the turn away from the T-pose in Euler
/// angles [degrees], applied about z, then x, then y. Knees and elbows turn with thigh
/// and upper arm, as straps above them would. The chest is the upper chest's joint,
/// failing that the chest's; joints that a body lacks are not sent. Same input, same
/// bytes; nothing is allocated after the first frame.
class VrchatTrackers {
 public:
  /// Precondition: t_pose_from_joint is empty or has one rotation per joint.
  explicit VrchatTrackers(const Skeleton& skeleton,
                          const VrchatTrackersOptions& options = {});

  /// One frame, as a packet for UdpSender. Valid until the next call.
  /// Precondition: finite transforms, one per joint of the skeleton.
  [[nodiscard]] std::span<const std::uint8_t> encode(
      std::span<const RigidTransform> world_from_joint);

  /// How many trackers a frame has, the head included.
  [[nodiscard]] std::size_t count() const { return trackers_.size(); }

 private:
  struct Tracker {
    std::string position_address;
    std::string rotation_address;
    JointIndex place{};
    JointIndex turn{};
    glm::dquat joint_from_t_pose{1.0, 0.0, 0.0, 0.0};
  };
  std::vector<Tracker> trackers_;
  OscWriter writer_;
};

/// Angles (x, y, z) [rad] with rotation = Ry * Rx * Rz: about z first, then x, then y. At
/// x = +-90 degrees, where z and y are one turn, z is 0.
[[nodiscard]] glm::dvec3 zxy_angles(const glm::dquat& rotation);

}  // namespace marey::live
