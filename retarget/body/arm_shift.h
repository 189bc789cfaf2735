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
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/posed_frames.h"

namespace marey::retarget {

/// Displacement of one arm in one frame: the wrist's, in the world, and the elbow's about
/// the line from shoulder to wrist. The hand keeps its world rotation.
struct ArmShift {
  glm::dvec3 wrist_m{0.0};
  double swivel_rad = 0.0;
};

/// One shift per frame, left and right.
using ArmShifts = std::array<std::vector<ArmShift>, 2>;

/// Positions of the joints of an arm. World, [m].
struct ArmPlaces {
  glm::dvec3 shoulder{0.0};
  glm::dvec3 elbow{0.0};
  glm::dvec3 wrist{0.0};
};

/// Maximum displacement of an arm away from its own body: shares of its length, and
/// swivel. Drawn bodies often rest with their arms inside the trunk; a full displacement
/// would hold such arms out like wings.
inline constexpr double kMaxWayOut = 0.35;
inline constexpr double kMaxSwivel_rad = 0.8;

/// Returns a shift of an arm of that length, limited to these maxima: unchanged while it
/// is small (to 0.05 percent at half of the maximum), smoothly compressed beyond.
[[nodiscard]] ArmShift limited_shift(const ArmShift& shift, double arm_length_m);

/// Aims an arm of that length from its shoulder at a position [m]. The half-plane of the
/// elbow turns along by the smallest rotation, then by the swivel. An arm that would be
/// stretched beyond 97 percent, or beyond its current extension, is stretched ever less,
/// and never out of reach. Returns false, without effect, for a position in the shoulder.
bool aim_arm(const glm::dvec3& wrist_from_shoulder_m,
             double length_m,
             double swivel_rad,
             NormalizedLimb& arm);

/// Returns the limb that moves the wrist of an arm at `now` by the shift, as aim_arm()
/// does. Pure, allocates nothing (also the functions below).
[[nodiscard]] NormalizedLimb shifted_limb(const LimbMap& arm,
                                          const ArmPlaces& now,
                                          const NormalizedLimb& limb,
                                          const ArmShift& shift);
/// Returns the joint positions of the shifted arm.
[[nodiscard]] ArmPlaces shifted_places(const LimbMap& arm,
                                       const ArmPlaces& now,
                                       const NormalizedLimb& limb,
                                       const ArmShift& shift);
/// Returns the joint positions of an arm of a posed body.
[[nodiscard]] ArmPlaces arm_places(const LimbMap& arm,
                                   std::span<const RigidTransform> world_from_joint);

/// The arms of a motion, and their positions when shifted.
class Arms {
 public:
  /// Precondition: `map` was made from the skeleton of `frames`; both outlive this.
  Arms(const PosedFrames& frames, const BodyMap& map);

  [[nodiscard]] std::size_t count() const { return frames_->count(); }
  /// True if the body has that arm, complete.
  [[nodiscard]] bool has(int side) const {
    return map_->limbs[static_cast<std::size_t>(side)].has_value();
  }
  /// Precondition (also of the functions below): has(side), t < count().
  [[nodiscard]] const LimbMap& limb(int side) const {
    return *map_->limbs[static_cast<std::size_t>(side)];
  }
  [[nodiscard]] ArmPlaces places(std::size_t t, int side) const;
  /// Returns the limb that moves the wrist by the shift, as aim_arm() does: beyond 97
  /// percent of its length, some millimetres short.
  [[nodiscard]] NormalizedLimb shifted_limb(std::size_t t,
                                            int side,
                                            const ArmShift& shift) const;
  [[nodiscard]] ArmPlaces places(std::size_t t, int side, const ArmShift& shift) const;
  /// Distance of the shifted wrist from its target. [m]
  [[nodiscard]] double out_of_reach_m(std::size_t t,
                                      int side,
                                      const ArmShift& shift) const;

 private:
  const PosedFrames* frames_;
  const BodyMap* map_;
  std::array<std::vector<NormalizedLimb>, 2> limbs_;
};

/// Moves the arms of the motion from which `arms` was made. Frames whose shifts are zero
/// to a nanometre keep their bytes; only upper arms, forearms and hands are written.
/// Unmarked joints of a shifted arm are set to their rest rotation.
void shift_arms(const Arms& arms,
                const BodyMap& map,
                const PosedFrames& frames,
                const ArmShifts& shifts,
                Motion& motion);

}  // namespace marey::retarget
