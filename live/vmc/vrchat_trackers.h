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

/// Port at which VRChat receives trackers.
inline constexpr int kVrchatPort = 9000;

struct VrchatTrackersOptions {
  /// World rotation of each joint's frame in the T-pose, as Character::t_pose_from_joint;
  /// empty if the rest pose is a T-pose. Read only by the constructor.
  std::span<const glm::dquat> t_pose_from_joint = {};
  bool knees = true;
  bool elbows = true;
  bool chest = true;
  /// Also sends the head's place. VRChat uses it to move all trackers to the headset. Off
  /// if the world is already the headset's.
  bool head = true;
};

/// Encodes a body's trackers for VRChat (docs.vrchat.com/docs/osc-trackers): a bundle of
/// /tracking/trackers/N/position and /rotation, three floats each.
///
///     1 hip, 2 chest, 3 and 4 feet, 5 and 6 knees, 7 and 8 elbows, left before right
///
/// The numbers do not depend on which trackers are sent. Positions are joint centres in
/// Unity's world, left-handed, Y up [m]; rotations are relative to the T-pose, in Euler
/// angles [degrees], applied about z, then x, then y. Knees and elbows rotate with thigh
/// and upper arm, like trackers strapped above them. The chest is the joint of the upper
/// chest, or else of the chest; joints that a body lacks are not sent. The same input
/// gives the same bytes; nothing is allocated after the first frame.
class VrchatTrackers {
 public:
  /// Selects the trackers that the skeleton has.
  /// Precondition: t_pose_from_joint is empty or has one rotation per joint.
  explicit VrchatTrackers(const Skeleton& skeleton,
                          const VrchatTrackersOptions& options = {});

  /// Encodes one frame as a packet for UdpSender. Valid until the next call.
  /// Precondition: finite transforms, one per joint of the skeleton.
  [[nodiscard]] std::span<const std::uint8_t> encode(
      std::span<const RigidTransform> world_from_joint);

  /// Returns the number of trackers of a frame, the head included.
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

/// Returns angles (x, y, z) [rad] with rotation = Ry * Rx * Rz: about z first, then x,
/// then y. At x = +-90 degrees, where z and y are about the same axis, z is 0.
[[nodiscard]] glm::dvec3 zxy_angles(const glm::dquat& rotation);

}  // namespace marey::live
