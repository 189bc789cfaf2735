// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"

namespace marey::retarget {

/// Rotation of a joint in whole-body steps.
enum class Turning : unsigned char {
  kRigid,  ///< Keeps its rotation in its parent.
  kBall,
  kHinge,  ///< Middle of a limb: rotates about the axis of the limb.
};

/// Position of a constrained point on a limb (Kulpa 2005, annex B).
enum class LimbPlace : unsigned char {
  kUpper,      ///< B.2: rotation of the whole limb.
  kLower,      ///< Also bend and swing; B.3 also spins (see close_limb_on()).
  kExtremity,  ///< B.1: bend and swing; the half-plane is kept.
};

/// Type of the goal that a target is computed from.
enum class GoalKind : unsigned char {
  kDistanceToPoint,
  kDistanceToOther,  ///< A point of the body: that of a constraint, or its own.
  kAllowedSpace,
  kForbiddenSpace,
  kOrientation,
  kSupport,
};

/// One target of a plan: 3 rows of the whole-body step.
struct PointPlan {
  int constraint = 0;  ///< Position in the constraint set.
  int joint = 0;
  GoalKind goal = GoalKind::kDistanceToPoint;
  int other_joint = -1;      ///< For kDistanceToOther.
  bool at_distance = false;  ///< True for a distance above 0.
  int level = 0;             ///< 0 for supports; others from 1, the most important first.
  int top = 0;               ///< Last joint up the chain that rotates for it.
  bool moves_root = true;
  int limb = -1;  ///< Limb of the point, if the range covers the limb; else -1.
  LimbPlace place = LimbPlace::kExtremity;
  /// Orientation of a limb's extremity: set directly, without a whole-body step.
  bool direct = false;
  bool stands_flat = false;  ///< Support that also sets the orientation of the foot.
  /// Supports of the foot that contains this point: the point is fixed while one of them
  /// is active.
  std::vector<int> firm_under;
  std::vector<int> chain;  ///< Joints that rotate for it, from its own to `top`.
  [[nodiscard]] bool turns_only() const { return goal == GoalKind::kOrientation; }
  bool operator==(const PointPlan&) const = default;
};

struct LimbPlan {
  int upper = 0;
  int lower = 0;
  int end = 0;
  bool can_support = false;
  std::vector<int> points;  ///< Position targets on this limb, most important first.
  std::vector<int> orientations;  ///< Orientation targets of its extremity, most
                                  ///< important first.
  /// Joints between the bones' ends (twist bones): they rotate with the bone above them.
  std::vector<int> between_upper;
  std::vector<int> between_lower;
  std::vector<int> beyond;  ///< Joints beyond `end`, parents first.
  std::vector<int> own;     ///< All of these, parents first.
  bool operator==(const LimbPlan&) const = default;
};

/// Joints common to two targets: from `lowest` up to `above`, `above` excluded.
struct SharedChain {
  int lowest = -1;  ///< -1: no joint rotates for both.
  int above = -1;   ///< -1: up to the root.
  bool root = false;
  bool operator==(const SharedChain&) const = default;
};

struct MassPlan {
  int joint = 0;
  int carried_by = 0;  ///< Nearest ancestor (or the joint itself) that is `live`.
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
  int limb = -1;                ///< Limb, for the group of an arm or leg.
  std::vector<int> sections;    ///< Positions in Plan::sections.
  std::vector<int> joints;      ///< All joints of the group.
  std::vector<PartPlan> parts;  ///< In the order of kinematic adaptation.
  bool operator==(const GroupPlan&) const = default;
};

/// Structure shared by all bodies that are adapted in parallel: hierarchy and types of
/// constraints, without lengths, postures or targets. Joints are those of the skeleton,
/// parents first.
struct Plan {
  int joint_count = 0;
  std::vector<int> parent;
  std::vector<Turning> turning;
  /// Per joint: first level of importance that it rotates for; 0 if it rotates for all.
  std::vector<int> turns_from;
  std::vector<int> limb_of_hinge;  ///< Per joint; -1 if the joint is no hinge.
  /// Joints that whole-body steps update: they rotate, carry a point, or are ancestors of
  /// such a joint. The others are rigidly attached to these.
  std::vector<int> live;
  std::vector<int> rest;      ///< Joints that are not live, parents first.
  std::vector<char> is_live;  ///< Per joint.
  std::vector<char> in_limb;  ///< Per joint.
  std::vector<LimbPlan> limbs;
  std::vector<std::vector<int>> sections;  ///< Vertebrae, low to high.
  std::vector<GroupPlan> groups;           ///< In the order of the character.
  std::vector<PointPlan> points;           ///< Supports first, then by importance.
  int level_count = 0;              ///< Number of levels of points that are not supports.
  std::vector<SharedChain> shared;  ///< Index a * points + b, with b <= a.
  /// Points whose chain contains joint j: elements begin[j]..begin[j + 1] of `through`.
  std::vector<int> through_begin;
  std::vector<int> through;
  std::vector<MassPlan> masses;  ///< Masses of the character, then its loads.
  std::size_t own_masses = 0;    ///< Number of masses that are not loads.
  std::vector<int> limited;      ///< Joints of Character::limits.
  std::vector<int> limit_of;     ///< Per joint: position in Character::limits, or -1.
  bool has_limits = false;
  bool has_supports = false;  ///< True if a point is a support.
  /// First and last joint of the abdomen, for a body with limited flexibility; otherwise
  /// -1.
  int abdomen_low = -1;
  int abdomen_high = -1;
  [[nodiscard]] bool has_hamstrings() const { return abdomen_high >= 0; }
  /// Returns true if `joint` is `ancestor` or one of its descendants. Linear in the
  /// depth.
  [[nodiscard]] bool is_at_or_below(int joint, int ancestor) const {
    while (joint > ancestor) joint = parent[static_cast<std::size_t>(joint)];
    return joint == ancestor;
  }
  bool operator==(const Plan&) const = default;
};

/// Builds the plan of a character. Bodies with equal plans can be solved in one batch.
/// `balance`: adds the groups that rotate for balance without a constraint. Precondition:
/// check_character() and check_constraints() found no errors.
[[nodiscard]] Plan make_plan(const Character& character,
                             const ConstraintSet& constraints,
                             bool balance);

}  // namespace marey::retarget
