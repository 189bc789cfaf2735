// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/transform.h"
#include "retarget/body/arm_shift.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/normalized_skeleton.h"

namespace marey::retarget {

struct LiveHandsOptions {
  /// As in RefineHandsOptions.
  std::optional<BodyVolume> source_volume;
  std::optional<BodyVolume> avatar_volume;
  /// A hand of the source that is nearer to its body than `near_legs` has the same
  /// distance and position on the avatar; one beyond `far_legs` is free. In leg lengths.
  double near_legs = 0.03;
  double far_legs = 0.2;
  /// Time constant with which hands and elbows follow their targets, applied twice so
  /// that their speed is continuous for any target. [s]
  double settle_s = 0.06;
  /// The same for moving arms out of trunk and thighs: a longer time permits more
  /// penetration. [s]
  double leave_s = 0.025;
};

/// One posed body. Referenced objects must outlive it.
struct PosedVolume {
  const BodyMap& map;
  const BodyVolume& volume;
  std::span<const RigidTransform> world_from_joint;
  std::optional<double> floor_m = std::nullopt;  ///< World Y; as in ArmOfBody.
};

/// Live counterpart of refine_hands(), without future frames: hands near the body where
/// the source's are, arms no deeper in trunk and thighs than the source's.
///
/// Targets are a function of the current posture alone. Each of three points of a hand
/// has, for each part of the body within reach, the source's position relative to that
/// part (carried_over()), and the nearest parts have the largest weight. Arms in trunk,
/// thighs and floor are moved out (arm_penetration()). Hands on each other meet half way,
/// or where one of them is held. The state is the current shift of the arms, in axes that
/// rotate with the hips. A body equal to the source's is unchanged to 1e-9 m.
class LiveHands {
 public:
  void reset() { *this = LiveHands(); }
  /// Moves the arms of `posture`, the avatar's posed body. Allocates nothing; some ten
  /// microseconds. Precondition: since_last_s > 0.
  void move(const PosedVolume& source,
            const PosedVolume& avatar,
            const LiveHandsOptions& options,
            double since_last_s,
            NormalizedPose& posture);

 private:
  /// A number that follows another, critically damped.
  struct Follower {
    double value = 0.0;
    double per_s = 0.0;
    void follow(double wanted, double since_last_s, double settle_s);
  };
  /// A shift that follows another, in axes that rotate with the hips.
  struct Shift {
    std::array<Follower, 3> wrist_m;
    Follower swivel_rad;
    ArmShift follow(const ArmShift& wanted,
                    const glm::dquat& world_from_axes,
                    double since_last_s,
                    double settle_s);
    bool is_known = false;
  };
  struct Arm {
    Shift to_touch;
    Shift to_leave;
  };

  std::array<Arm, 2> arms_;
};

}  // namespace marey::retarget
