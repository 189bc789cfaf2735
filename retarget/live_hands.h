// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/transform.h"
#include "retarget/arm_shift.h"
#include "retarget/body_map.h"
#include "retarget/body_volume.h"
#include "retarget/normalized_skeleton.h"

namespace marey::retarget {

struct LiveHandsOptions {
  /// As in RefineHandsOptions.
  std::optional<BodyVolume> source_volume;
  std::optional<BodyVolume> avatar_volume;
  /// A hand of the source that is nearer than this to its body is, on the avatar, as far
  /// from the same place of its; one that is further than the other is free. Leg lengths.
  double near_legs = 0.03;
  double far_legs = 0.2;
  /// Time constant with which hands and elbows follow what is wanted of them, twice over,
  /// so that their speed is continuous, whatever is wanted. [s]
  double settle_s = 0.06;
  /// The same for what brings arms out of trunk and thighs: later is deeper. [s]
  double leave_s = 0.025;
};

/// One posed body. What it refers to outlives it.
struct PosedVolume {
  const BodyMap& map;
  const BodyVolume& volume;
  std::span<const RigidTransform> world_from_joint;
  std::optional<double> floor_m = std::nullopt;  ///< World Y; as in ArmOfBody.
};

/// What refine_hands() is for whole motions, knowing nothing of the future: hands near
/// the body where the source's are, arms no deeper in trunk and thighs than the source's.
///
/// What is wanted is a function of this posture alone. Each of three points of a hand
/// has, to each part of the body within reach, the place beside it that the source has
/// (carried_over()), and the nearest count most; what of the arm is within trunk, thighs
/// and floor leaves them (arm_need()). Hands that are on each other meet half way, or where
/// one of them is held. What is remembered is how far the arms have followed, in axes that
/// turn with the hips. A body like the source's is left as it is, to 1e-9 m.
class LiveHands {
 public:
  void forget() { *this = LiveHands(); }
  /// Changes the arms of `posture`, which is the avatar's as posed. Allocates nothing;
  /// some ten microseconds. Precondition: since_last_s > 0.
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
  /// A shift that follows another, in axes that turn with the hips.
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
