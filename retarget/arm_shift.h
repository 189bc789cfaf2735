// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/normalized_skeleton.h"
#include "retarget/posed_frames.h"

namespace marey::retarget {

/// How one arm is moved in one frame: the wrist from where it is, in the world, and the
/// elbow about the line from shoulder to wrist. The hand is not turned in the world.
struct ArmShift {
  glm::dvec3 wrist_m{0.0};
  double swivel_rad = 0.0;
};

/// One shift per frame, left and right.
using ArmShifts = std::array<std::vector<ArmShift>, 2>;

/// Where the joints of an arm are. World, [m].
struct ArmPlaces {
  glm::dvec3 shoulder{0.0};
  glm::dvec3 elbow{0.0};
  glm::dvec3 wrist{0.0};
};

/// How far an arm gives way to the body that it hangs on, at most: shares of its length, and
/// swivel. Where arms hang within a trunk at rest already, as drawn bodies have them, all
/// of the way out would hold them out like wings.
inline constexpr double kMostWayOut = 0.35;
inline constexpr double kMostSwivel_rad = 0.8;

/// A shift of an arm of that length, no further than that: as it is while it is small (to
/// 0.05 percent at half of it), smoothly less beyond.
[[nodiscard]] ArmShift within_reason(const ArmShift& shift, double arm_length_m);

/// Points an arm of that length at a place, from its shoulder [m]. The half-plane of the
/// elbow turns along by the smallest rotation, then by the swivel. An arm that would be
/// stretched beyond 97 percent, or beyond what it is, goes in that direction ever less,
/// and never out of reach. False, and nothing done, for a place in the shoulder.
bool aim_arm(const glm::dvec3& wrist_from_shoulder_m,
             double length_m,
             double swivel_rad,
             NormalizedLimb& arm);

/// The limb that brings the wrist of an arm there that is at `now`, as aim_arm() does.
/// Pure, allocates nothing (here and below).
[[nodiscard]] NormalizedLimb shifted_limb(const LimbMap& arm,
                                          const ArmPlaces& now,
                                          const NormalizedLimb& limb,
                                          const ArmShift& shift);
/// Where its joints are then.
[[nodiscard]] ArmPlaces shifted_places(const LimbMap& arm,
                                       const ArmPlaces& now,
                                       const NormalizedLimb& limb,
                                       const ArmShift& shift);
/// Of a posed body.
[[nodiscard]] ArmPlaces places_of(const LimbMap& arm,
                                  std::span<const RigidTransform> world_from_joint);

/// The arms of a motion, and where they would be when shifted.
class Arms {
 public:
  /// Precondition: `map` was made from the skeleton of `frames`; both outlive this.
  Arms(const PosedFrames& frames, const BodyMap& map);

  [[nodiscard]] std::size_t count() const { return frames_->count(); }
  /// Whether the body has that arm, complete.
  [[nodiscard]] bool has(int side) const {
    return map_->limbs[static_cast<std::size_t>(side)].has_value();
  }
  /// Precondition (here and below): has(side), t < count().
  [[nodiscard]] const LimbMap& limb(int side) const {
    return *map_->limbs[static_cast<std::size_t>(side)];
  }
  [[nodiscard]] ArmPlaces places(std::size_t t, int side) const;
  /// The limb that brings the wrist there, as aim_arm() does: beyond 97 percent of its
  /// length, some millimetres short.
  [[nodiscard]] NormalizedLimb shifted_limb(std::size_t t,
                                            int side,
                                            const ArmShift& shift) const;
  [[nodiscard]] ArmPlaces places(std::size_t t, int side, const ArmShift& shift) const;
  /// How far the wrist stays away from where the shift wants it. [m]
  [[nodiscard]] double out_of_reach_m(std::size_t t,
                                      int side,
                                      const ArmShift& shift) const;

 private:
  const PosedFrames* frames_;
  const BodyMap* map_;
  std::array<std::vector<NormalizedLimb>, 2> limbs_;
};

/// Moves the arms of the motion that `arms` was made of. Frames whose shifts are zero to
/// a nanometre keep their bytes; nothing but upper arms, forearms and hands is written.
/// Unmarked joints of a shifted arm are taken as at rest.
void shift_arms(const Arms& arms,
                const BodyMap& map,
                const PosedFrames& frames,
                const ArmShifts& shifts,
                Motion& motion);

}  // namespace marey::retarget
