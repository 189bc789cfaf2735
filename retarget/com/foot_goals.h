// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/com/com_plan.h"
#include "retarget/feet/foot_place.h"

namespace marey::retarget {

/// Returns the place of a foot in each frame of a motion. Side 0 is left. A body without
/// toe joints has identity there. Linear in frames.
/// Precondition: `map` was made from the motion's skeleton.
[[nodiscard]] std::vector<FootPlace> foot_places(const Motion& motion,
                                                 const BodyMap& map,
                                                 int side);

/// Properties of one foot's goals, one entry per frame; an empty span is zero everywhere.
struct FootGoalCourse {
  std::span<const glm::dvec3> displaced_m;  ///< Added to the ankle's place.
  std::span<const double> hold;             ///< As FootGoal::hold.
  std::span<const double> heel_may_rise;    ///< As FootGoal::heel_may_rise.
  /// As FootGoal::root_gives_way; empty: 1 everywhere.
  std::span<const double> root_gives_way{};
};

/// Returns the goals that keep a foot where the motion has it, displaced.
/// Precondition: as foot_places(); each span is empty or has one entry per frame.
[[nodiscard]] std::vector<FootGoal> foot_goals(const Motion& motion,
                                               const BodyMap& map,
                                               int side,
                                               const FootGoalCourse& course);

}  // namespace marey::retarget
