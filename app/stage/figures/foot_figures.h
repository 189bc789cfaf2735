// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "app/stage/figures/worst_value.h"

namespace marey::app {

/// Part of a foot that stands.
enum class FootStance {
  kNone,
  kHeel,  ///< On the heel alone: the ankle's place stands for it.
  kFlat,
  kBall,  ///< On the ball alone.
};

/// One foot in one step of a scene.
struct FootStep {
  double time_s = 0.0;
  FootStance stance = FootStance::kNone;
  /// Places relative to the part of the floor on which the foot stands. [m]
  glm::dvec3 ankle_on_floor{0.0};
  glm::dvec3 ball_on_floor{0.0};  ///< The toe joint.
  glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
};

/// Returns the largest displacement of the foot along the floor since it began to stand
/// on the part that stands. The ankle counts on the heel, the toe joint on the ball, and
/// on the whole foot the one that moved less, since a foot that turns about one of them
/// does not slide (foot_twist_deg()). [mm] Linear.
[[nodiscard]] WorstValue foot_slide_mm(std::span<const FootStep> steps);

/// Returns the largest turn of the foot about the vertical since it began to stand: the
/// change of the horizontal direction from heel to toes. [deg] Linear.
[[nodiscard]] WorstValue foot_twist_deg(std::span<const FootStep> steps);

/// Returns the part that stands of a foot that bears: on its ball if the ankle is raised
/// more than the toe joint, on its heel in the opposite case. `tolerance_m` is the
/// difference that still counts as the whole foot.
[[nodiscard]] FootStance stance_of(double ankle_raised_m,
                                   double ball_raised_m,
                                   double tolerance_m);

}  // namespace marey::app
