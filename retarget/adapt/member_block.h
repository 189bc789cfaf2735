// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "retarget/adapt/adapter_options.h"
#include "retarget/adapt/plan/adapt_numbers.h"
#include "retarget/constraints/activation.h"

namespace marey::retarget {

/// State of an adapter between postures, except its arrays.
struct MemberHead {
  double unit_m = 1.0;  ///< BodyNumbers::unit_m.
  AdaptOptions options;
  /// Mode of the options while balance is switched off; kOff: it is not.
  BalanceMode paused_balance = BalanceMode::kOff;
  std::optional<glm::dvec3> com_in_world;  ///< Target of the centre of mass.
  glm::dvec3 origin_in_world{0.0};         ///< Root of the current reference.
  Control control = Control::kPriority;    ///< Used by the current solve.
  /// The control that is fading out, and its current share.
  Control left_control = Control::kPriority;
  double left_share = 0.0;
  /// Fraction of the fade's duration completed at the last posture, 0 to 1, and the
  /// (extrapolated) start time of the fade; known from the next posture on.
  double passed = 1.0;
  std::optional<double> passes_since_s;
  AdaptReport report;  ///< For the last posture.
};

/// State of one constraint.
struct MemberTarget {
  /// Constants and current target. `weight` is the importance. A support's position and
  /// rotation are those of the user, if given.
  TargetNumbers numbers;
  GoalKind goal = GoalKind::kDistanceToPoint;
  bool is_placed = false;  ///< Support with a footprint.
  bool is_turned = false;  ///< Support with an orientation.
  bool turns = false;      ///< Support that may turn about its point.
  bool has_begun = false;
  bool is_at_joint = true;  ///< Its point has an offset of zero.
  /// For a distance to the point of another constraint: position of that constraint in
  /// the set. -1: the other point is `numbers.b`.
  int other = -1;
  double max_met_error = 0.0;  ///< max_met_error() of the constraint.
  glm::dquat t_pose_from_joint{1.0, 0.0, 0.0, 0.0};
  /// Place in the reference of a support when it began.
  glm::dvec3 begun_in_world{0.0};
  glm::dquat begun_rotation{1.0, 0.0, 0.0, 0.0};
};

/// One mass of a body or one load, for the centre of mass.
struct MemberMass {
  glm::dvec3 p_in_joint{0.0};
  double mass_kg = 0.0;
};

}  // namespace marey::retarget
