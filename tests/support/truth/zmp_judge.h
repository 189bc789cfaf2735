// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/human/contacts.h"
#include "core/humanoid.h"
#include "core/motion.h"

namespace marey::testing {

/// One foot as the judge needs it: its joints, their rotations in the T-pose, and places
/// on the sole from the ankle and from the toe joint, in the T-pose's axes.
struct JudgedFoot {
  JointIndex ankle{};
  glm::dquat t_pose_from_ankle{1.0, 0.0, 0.0, 0.0};
  std::optional<JointIndex> toes{};
  glm::dquat t_pose_from_toes{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 heel_m{0.0};
  glm::dvec3 ball_m{0.0};
  glm::dvec3 tip_from_ball_m{0.0};
};
using JudgedFeet = std::array<JudgedFoot, 2>;

/// Returns the feet of a retarget::BodyMap.
template <class Map>
[[nodiscard]] JudgedFeet judged_feet(const Map& map) {
  JudgedFeet out;
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    JudgedFoot& foot = out[s];
    foot.ankle = map.leg(side).end;
    foot.t_pose_from_ankle = map.joints[index(foot.ankle)].t_pose_from_joint;
    const HumanBone toes = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
    foot.toes = map.joint_of[index(toes)];
    if (foot.toes)
      foot.t_pose_from_toes = map.joints[index(*foot.toes)].t_pose_from_joint;
    foot.heel_m = map.feet[s].heel_from_ankle_in_t_pose;
    foot.ball_m = map.feet[s].ball_from_ankle_in_t_pose;
    foot.tip_from_ball_m = map.feet[s].tip_from_ball_in_t_pose;
  }
  return out;
}

/// Zero moment point of one frame, computed by code that shares nothing with
/// dynamics/balance.
struct JudgedZmp {
  double vertical_force_g = 0.0;  ///< Over the weight.
  glm::dvec2 p_xz_m{0.0};
  /// Distance outside of the support; 0 inside. nullopt: no foot bears.
  std::optional<double> outside_m{};
};

/// Judges all frames by the balance of moments about the centre of mass: the derivative
/// of the angular momentum is the moment of the ground reaction at the zero moment point.
/// Derivatives are those of cubic least squares over `window_s`, by Gaussian elimination;
/// near the ends of parabolas. A point is outside of soles if it sees their corners
/// within half a turn. Preconditions: the feet, masses and contacts are those of the
/// motion, which has at least five frames; its gravity is 9.81 m/s^2.
[[nodiscard]] std::vector<JudgedZmp> judge_zmp(const Motion& motion,
                                               const JudgedFeet& feet,
                                               std::span<const PointMass> masses,
                                               const Contacts& contacts,
                                               double floor_height_m,
                                               double window_s = 0.12);

}  // namespace marey::testing
