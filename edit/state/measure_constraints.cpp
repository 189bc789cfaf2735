// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/measure_constraints.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/pose.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/check_constraints.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::edit {

double worst_constraint_m(const EditState& state) {
  if (state.constraints.constraints.empty()) return 0.0;
  const auto character =
      retarget::make_character("motion", state.motion.skeleton, state.map);
  if (!character || !retarget::check_constraints(state.constraints, *character))
    return 0.0;
  double worst_m = 0.0;
  std::vector<retarget::ConstraintMeasure> measures;
  for (const Constraint& constraint : state.constraints.constraints) {
    measures.emplace_back(*character, constraint, state.constraints);
  }
  std::vector<std::optional<glm::dvec3>> footprints(measures.size());
  std::vector<RigidTransform> joints(state.motion.skeleton.joints.size());
  for (int frame = 0; frame < state.frame_count(); ++frame) {
    const double time_s = frame / state.motion.rate.hz;
    world_from_joints(state.motion.skeleton,
                      state.motion.poses[static_cast<std::size_t>(frame)],
                      joints);
    for (std::size_t i = 0; i < measures.size(); ++i) {
      const Constraint& constraint = state.constraints.constraints[i];
      const double active = retarget::activation(constraint.activation, time_s);
      if (active > 0.0 && !footprints[i])
        footprints[i] = measures[i].point().in_world(joints);
      if (active < 1.0) continue;
      worst_m = std::max(worst_m, measures[i].shortfall(joints, *footprints[i]).m);
    }
  }
  return worst_m;
}

}  // namespace marey::edit
