// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/hand_motion.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// Step of the differences that derive rotations: rounding and curvature both cost less
// than 1e-5 of an angular acceleration of 100 rad/s^2.
constexpr double kTurnStep_s = 5e-4;

glm::dvec3 near_branch(const glm::dvec3& vector_rad, const glm::dvec3& near_rad) {
  const double angle = glm::length(vector_rad);
  if (angle < 1e-9) return vector_rad;
  const glm::dvec3 other = vector_rad * (1.0 - glm::two_pi<double>() / angle);
  return glm::distance(other, near_rad) < glm::distance(vector_rad, near_rad)
             ? other
             : vector_rad;
}

Motion3 central_differences(const glm::dvec3& before,
                            const glm::dvec3& now,
                            const glm::dvec3& after,
                            double step_s) {
  return {now,
          (after - before) / (2.0 * step_s),
          (after - 2.0 * now + before) / (step_s * step_s)};
}

Motion3 backward_differences(const glm::dvec3& two_before,
                             const glm::dvec3& before,
                             const glm::dvec3& now,
                             double step_s) {
  return {now,
          (3.0 * now - 4.0 * before + two_before) / (2.0 * step_s),
          (now - 2.0 * before + two_before) / (step_s * step_s)};
}

bool is_zero(const Motion3& motion) {
  const glm::dvec3 zero(0.0);
  return motion.value == zero && motion.rate == zero && motion.acceleration == zero;
}

}  // namespace

HandMotion hand_motion(const RigidTransform& before,
                       const RigidTransform& now,
                       const RigidTransform& after,
                       double step_s) {
  MAREY_ASSERT(step_s > 0.0);
  const Motion3 place =
      central_differences(before.translation, now.translation, after.translation, step_s);
  const glm::dquat now_inverse = glm::conjugate(now.rotation);
  const Motion3 turn = central_differences(rotation_vector(before.rotation * now_inverse),
                                           glm::dvec3(0.0),
                                           rotation_vector(after.rotation * now_inverse),
                                           step_s);
  return {place.value,
          place.rate,
          place.acceleration,
          now.rotation,
          turn.rate,
          turn.acceleration};
}

HandMotion hand_motion_until(const RigidTransform& two_before,
                             const RigidTransform& before,
                             const RigidTransform& now,
                             double step_s) {
  MAREY_ASSERT(step_s > 0.0);
  const Motion3 place = backward_differences(
      two_before.translation, before.translation, now.translation, step_s);
  const glm::dquat now_inverse = glm::conjugate(now.rotation);
  const Motion3 turn =
      backward_differences(rotation_vector(two_before.rotation * now_inverse),
                           rotation_vector(before.rotation * now_inverse),
                           glm::dvec3(0.0),
                           step_s);
  return {place.value,
          place.rate,
          place.acceleration,
          now.rotation,
          turn.rate,
          turn.acceleration};
}

RigidTransform continued(const HandMotion& hand, double after_s) {
  const double half_square = 0.5 * after_s * after_s;
  return {rotation_from_vector(after_s * hand.turn_rad_s +
                               half_square * hand.turn_acceleration_rad_s2) *
              hand.world_from_hand,
          hand.p_in_world + after_s * hand.velocity_m_s +
              half_square * hand.acceleration_m_s2};
}

Motion3 turn_between(const HandMotion& from,
                     const HandMotion& to,
                     const glm::dvec3& near_rad) {
  const auto turn_at = [&](double after_s, const glm::dvec3& near) {
    return near_branch(rotation_vector(continued(to, after_s).rotation *
                                       glm::conjugate(continued(from, after_s).rotation)),
                       near);
  };
  const glm::dvec3 now = turn_at(0.0, near_rad);
  return central_differences(
      turn_at(-kTurnStep_s, now), now, turn_at(kTurnStep_s, now), kTurnStep_s);
}

HandMotion displaced(const HandMotion& hand,
                     const Motion3& displacement_m,
                     const Motion3& turn_rad) {
  HandMotion moved = hand;
  moved.p_in_world += displacement_m.value;
  moved.velocity_m_s += displacement_m.rate;
  moved.acceleration_m_s2 += displacement_m.acceleration;
  if (is_zero(turn_rad)) return moved;
  const auto rotation_at = [&](double after_s) {
    return RigidTransform{
        rotation_from_vector(turn_rad.value + after_s * turn_rad.rate +
                             0.5 * after_s * after_s * turn_rad.acceleration) *
            continued(hand, after_s).rotation,
        glm::dvec3(0.0)};
  };
  const HandMotion turned = hand_motion(
      rotation_at(-kTurnStep_s), rotation_at(0.0), rotation_at(kTurnStep_s), kTurnStep_s);
  moved.world_from_hand = turned.world_from_hand;
  moved.turn_rad_s = turned.turn_rad_s;
  moved.turn_acceleration_rad_s2 = turned.turn_acceleration_rad_s2;
  return moved;
}

}  // namespace marey::engine
