// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/human/centre_of_mass.h"
#include "core/motion.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/com/follow_com.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {

/// A body with masses, ready to follow its centre of mass.
struct HeavyBody {
  Skeleton skeleton;
  BodyMap map;
  std::vector<PointMass> masses;

  [[nodiscard]] ComFollower follower() const { return {skeleton, map, masses, {60.0}}; }
  [[nodiscard]] glm::dvec3 com(const Pose& pose) const {
    return centre_of_mass(masses, world_from_joints(skeleton, pose));
  }
  [[nodiscard]] glm::dvec3 place(const Pose& pose, JointIndex joint) const {
    return world_from_joints(skeleton, pose)[index(joint)].translation;
  }
};

/// A body of any size (0.6 to 2.5 m), with toes or none, with random joint axes or twist
/// joints in the legs, by seed.
[[nodiscard]] HeavyBody heavy_body(std::uint64_t seed);
[[nodiscard]] HeavyBody heavy(Skeleton skeleton);

/// A posture on bent legs, feet nearly flat, trunk and arms at random. `squat` is the
/// knees' mean angle. [rad]
[[nodiscard]] Pose squatting(const HeavyBody& body, double squat, testing::Dice& dice);

/// Goals of both feet where the posture has them.
[[nodiscard]] std::array<FootGoal, 2> own_feet(const HeavyBody& body,
                                               const Pose& pose,
                                               double hold,
                                               double heel_may_rise);

struct Followed {
  Pose pose;
  FollowComReport report;
};
/// Calls follow_com() for one frame.
[[nodiscard]] Followed followed(const HeavyBody& body,
                                const Pose& reference,
                                const glm::dvec3& com_in_world,
                                const std::array<FootGoal, 2>& feet);

/// Largest difference of bone lengths of a pose from the skeleton's. [m]
[[nodiscard]] double stretched_m(const HeavyBody& body, const Pose& pose);
/// Distance from hip to ankle over the leg's length at rest.
[[nodiscard]] double extension(const HeavyBody& body, const Pose& pose, int side);
/// Largest distance between the same joints of two poses. [m]
[[nodiscard]] double moved_m(const HeavyBody& body, const Pose& a, const Pose& b);

}  // namespace marey::retarget
