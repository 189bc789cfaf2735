// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"
#include "tests/support/bodies/random_bodies.h"

/// Bodies, postures and measures for tests of the adapter. All measures are computed here
/// independently, in double, from postures alone; values reported by the adapter are not
/// used.
namespace marey::retarget {

using testing::Dice;

/// Common properties of both methods. Suites that derive from it are instantiated with
/// the methods that have these properties.
class EveryMethod : public ::testing::TestWithParam<Method> {
 protected:
  [[nodiscard]] static AdaptOptions options() {
    AdaptOptions out;
    out.method = GetParam();
    return out;
  }
};
[[nodiscard]] inline auto strict_method() {
  return ::testing::Values(Method::kStrict);
}
[[nodiscard]] inline auto thesis_method() {
  return ::testing::Values(Method::kThesis);
}
[[nodiscard]] inline auto both_methods() {
  return ::testing::Values(Method::kStrict, Method::kThesis);
}
[[nodiscard]] inline std::string name_of(const ::testing::TestParamInfo<Method>& info) {
  return info.param == Method::kStrict ? "strict" : "thesis";
}

/// make_humanoid() of average proportions as a character; with a bag of 10 kg that the
/// left hand may carry, called "bag".
[[nodiscard]] Character human(bool with_limits, double stature_m = 1.75);
/// make_character() of any human skeleton.
[[nodiscard]] Character human_of(const Skeleton& skeleton, bool with_limits);

struct Limb {
  std::size_t upper = 0;
  std::size_t lower = 0;
  std::size_t end = 0;
  glm::dvec3 hinge_in_upper{0.0};
};
/// Returns the limb that has this joint, which must be one of its three or a child of its
/// end.
[[nodiscard]] Limb limb_of(const Character& character, std::size_t joint);

[[nodiscard]] std::size_t joint_at(const Character& character, std::string_view segment);

/// Slightly bent knees, elbows and hips, arms hanging, as in relaxed standing.
[[nodiscard]] Pose waiting(const Character& character);
/// From the rest pose: ball joints rotated by up to `max_rad`, limbs bent in their
/// natural direction by 0.15 to 1.7 rad, the root moved and rotated; within the limits.
[[nodiscard]] Pose random_posture(const Character& character, Dice& dice, double max_rad);

[[nodiscard]] Constraint contact(const std::string& id,
                                 const std::string& segment,
                                 const glm::dvec3& p_in_world,
                                 const glm::dvec3& offset_in_t_pose = glm::dvec3(0.0),
                                 double importance = 1.0);
[[nodiscard]] Constraint standing(const std::string& id, const std::string& segment);

/// With limits: a human without, a human with, a quadruped.
[[nodiscard]] std::vector<Character> bodies();

/// Fails the test when it cannot be made.
[[nodiscard]] Adapter make_adapter(const Character& character,
                                   const ConstraintSet& constraints,
                                   const AdaptOptions& options = {});

struct Adapted {
  Pose pose;
  AdaptReport report;
};
/// Uses a new adapter, at a time after all starts.
[[nodiscard]] Adapted adapted(const Character& character,
                              const ConstraintSet& constraints,
                              const Pose& reference,
                              const AdaptOptions& options = {});

/// For a character whose skeleton rests in its T-pose with the world's axes.
[[nodiscard]] glm::dvec3 place_of(const Character& character,
                                  const Pose& pose,
                                  const BodyPoint& point);
/// Returns the distance of the constraint's point from its goal. [m] Precondition: the
/// goal is a DistanceToPoint.
[[nodiscard]] double target_distance_m(const Character& character,
                                       const Pose& pose,
                                       const Constraint& constraint);
/// Rotation of a segment in the world, from the T-pose.
[[nodiscard]] glm::dquat rotation_of(const Character& character,
                                     const Pose& pose,
                                     std::string_view segment);
/// Includes its masses, and optionally its loads.
[[nodiscard]] glm::dvec3 centre_of_mass(const Character& character,
                                        const Pose& pose,
                                        bool loaded = false);

/// Returns the maximum distance of a joint of `a` from its position in `b`. [m]
[[nodiscard]] double furthest_m(const Character& character, const Pose& a, const Pose& b);
/// Returns the maximum rotation of a joint in its parent between `a` and `b`. [rad]
[[nodiscard]] double max_turned_rad(const Pose& a, const Pose& b);
[[nodiscard]] double angle_between_rad(const glm::dquat& a, const glm::dquat& b);
/// Returns the maximum angle of a joint beyond its limits, except those of `free`. [rad]
[[nodiscard]] double beyond_limits_rad(const Character& character,
                                       const Pose& pose,
                                       const std::vector<std::size_t>& free = {});
[[nodiscard]] bool is_finite(const Pose& pose);
[[nodiscard]] bool same_bits(const Pose& a, const Pose& b);

}  // namespace marey::retarget
