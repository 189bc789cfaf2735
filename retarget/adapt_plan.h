// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"

namespace marey::retarget {

/// How a joint turns in whole-body steps.
enum class Turning : unsigned char {
  kRigid,  ///< Not at all: it keeps its rotation in its parent.
  kBall,
  kHinge,  ///< The middle of a limb: about the limb's own axis.
};

/// Where a constrained point sits on a limb (Kulpa 2005, annex B).
enum class LimbPlace : unsigned char {
  kUpper,      ///< B.2: a rotation of the whole limb.
  kLower,      ///< Bend and swing, too; B.3 also spins (see close_limb_on()).
  kExtremity,  ///< B.1: bend and swing, the half-plane kept.
};

/// What the target of a point is made from.
enum class GoalKind : unsigned char {
  kDistanceToPoint,
  kDistanceToOther,  ///< A point of the body: a constraint's, or a place of its own.
  kAllowedSpace,
  kForbiddenSpace,
  kOrientation,
  kSupport,
};

/// One wish of a plan: 3 rows of the whole-body step.
struct PointPlan {
  int constraint = 0;  ///< Position in the constraint set.
  int joint = 0;
  GoalKind goal = GoalKind::kDistanceToPoint;
  int other_joint = -1;      ///< Of kDistanceToOther.
  bool at_distance = false;  ///< Of a distance above 0.
  int level = 0;             ///< 0 is a support; others from 1, the most important first.
  int top = 0;               ///< The last joint up the chain that turns for it.
  bool moves_root = true;
  int limb = -1;  ///< Whose point it is, if the range covers the limb.
  LimbPlace place = LimbPlace::kExtremity;
  /// An orientation of a limb's extremity: set as it is asked, by no step of the body.
  bool direct = false;
  bool stands_flat = false;  ///< A support that has its foot's orientation, too.
  /// Supports whose foot it is a point of: nothing moves it while one of them stands.
  std::vector<int> firm_under;
  std::vector<int> chain;  ///< Joints that turn for it, from its own to `top`.
  [[nodiscard]] bool turns_only() const { return goal == GoalKind::kOrientation; }
  bool operator==(const PointPlan&) const = default;
};

struct LimbPlan {
  int upper = 0;
  int lower = 0;
  int end = 0;
  bool can_support = false;
  std::vector<int> points;  ///< Wishes for places on this limb, most important first.
  std::vector<int> orientations;  ///< Wishes for its extremity's, likewise.
  /// Joints that are only on the way (twist bones): they turn with the bone above them.
  std::vector<int> between_upper;
  std::vector<int> between_lower;
  std::vector<int> beyond;  ///< Joints past `end`, parents first.
  std::vector<int> own;     ///< All of these, parents first.
  bool operator==(const LimbPlan&) const = default;
};

/// What two wishes have in common: joints from `lowest` up to, but without, `above`.
struct SharedChain {
  int lowest = -1;  ///< -1: no joint turns for both.
  int above = -1;   ///< -1: up to the root.
  bool root = false;
  bool operator==(const SharedChain&) const = default;
};

struct MassPlan {
  int joint = 0;
  int carried_by = 0;  ///< The nearest joint that is `live`.
  bool operator==(const MassPlan&) const = default;
};

/// One part of a group: limb, section or segment.
struct PartPlan {
  PartKind kind = PartKind::kSegment;
  int index = 0;  ///< Position in Plan::limbs or Plan::sections; the segment's joint.
  bool operator==(const PartPlan&) const = default;
};

struct GroupPlan {
  int level = 2;
  bool balances = true;
  int limb = -1;                ///< Of an arm or leg.
  std::vector<int> sections;    ///< Positions in Plan::sections.
  std::vector<int> joints;      ///< All of it.
  std::vector<PartPlan> parts;  ///< In the order in which kinematics adapts them.
  bool operator==(const GroupPlan&) const = default;
};

/// What is the same for all bodies that are adapted side by side: how the skeleton hangs
/// together and what is asked, without lengths, postures or targets. Joints are those of
/// the skeleton, parents first.
struct Plan {
  int joint_count = 0;
  std::vector<int> parent;
  std::vector<Turning> turning;
  /// Per joint: the first level of importance that it turns for; 0 where it turns anyway.
  std::vector<int> turns_from;
  std::vector<int> limb_of_hinge;  ///< Per joint; -1.
  /// Joints that whole-body steps must follow: they turn, carry a point, or lead to one
  /// that does. The others hang rigidly from those.
  std::vector<int> live;
  std::vector<int> rest;      ///< The joints that are not live, parents first.
  std::vector<char> is_live;  ///< Per joint.
  std::vector<char> in_limb;  ///< Per joint.
  std::vector<LimbPlan> limbs;
  std::vector<std::vector<int>> sections;  ///< Vertebrae, low to high.
  std::vector<GroupPlan> groups;           ///< As in the character.
  std::vector<PointPlan> points;           ///< Supports first, then by importance.
  int level_count = 0;                     ///< Levels of points that are no supports.
  std::vector<SharedChain> shared;         ///< [a * points + b], b <= a.
  /// Points whose chain has this joint: positions begin[j]..begin[j + 1] of `through`.
  std::vector<int> through_begin;
  std::vector<int> through;
  std::vector<MassPlan> masses;  ///< The character's masses, then its loads.
  std::size_t own_masses = 0;    ///< How many of them are no loads.
  std::vector<int> limited;      ///< Joints of Character::limits.
  std::vector<int> limit_of;     ///< Per joint: position in Character::limits, or -1.
  bool has_limits = false;
  bool has_supports = false;  ///< Some point is one.
  /// The abdomen of a body whose flexibility is limited: from which joint to which. -1:
  /// it is not.
  int abdomen_low = -1;
  int abdomen_high = -1;
  [[nodiscard]] bool has_hamstrings() const { return abdomen_high >= 0; }
  /// Whether `joint` is `ancestor` or hangs on it. Linear in the way up.
  [[nodiscard]] bool is_at_or_below(int joint, int ancestor) const {
    while (joint > ancestor) joint = parent[static_cast<std::size_t>(joint)];
    return joint == ancestor;
  }
  bool operator==(const Plan&) const = default;
};

/// What makes two bodies fit for the same batch is an equal plan.
/// Precondition: check_character() and check_constraints() found nothing.
/// `balance`: the groups that balance turn too, without a constraint.
[[nodiscard]] Plan make_plan(const Character& character,
                             const ConstraintSet& constraints,
                             bool balance);

}  // namespace marey::retarget
