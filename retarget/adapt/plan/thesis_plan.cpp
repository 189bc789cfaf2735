// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/plan/thesis_plan.h"

#include <algorithm>

namespace marey::retarget {
namespace {

std::size_t to_size(int i) {
  return static_cast<std::size_t>(i);
}

bool has(const std::vector<int>& list, int x) {
  return std::find(list.begin(), list.end(), x) != list.end();
}

std::vector<int> live_below(const Plan& plan, int joint) {
  std::vector<int> out;
  for (const int j : plan.live) {
    if (plan.is_at_or_below(j, joint)) out.push_back(j);
  }
  return out;
}

// Returns false for supports (handled by the ground) and for orientations that
// close_limb() sets.
bool turns_segments(const PointPlan& point) {
  return point.goal != GoalKind::kSupport && !point.direct;
}

// A section is in range completely or not at all.
std::vector<int> points_through(const Plan& plan, const std::vector<int>& joints) {
  std::vector<int> out;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    if (!turns_segments(point)) continue;
    if (has(point.chain, joints.front())) out.push_back(static_cast<int>(k));
  }
  return out;
}

struct ThesisPlanBuilder {
  const Plan& plan;
  ThesisPlan out;

  void add_turn(ThesisGroup& group, ThesisTurn turn) {
    if (turn.points.empty()) return;
    turn.below = live_below(plan, turn.joints.front());
    group.steps.push_back({false, static_cast<int>(out.turns.size())});
    out.turns.push_back(std::move(turn));
  }

  void add_segment(const GroupPlan& from, ThesisGroup& group, int joint) {
    ThesisTurn turn;
    turn.joints = {joint};
    turn.points = points_through(plan, turn.joints);
    turn.support_limb = from.limb;
    if (from.limb >= 0 &&
        plan.is_at_or_below(joint, plan.limbs[to_size(from.limb)].end)) {
      turn.extremity_of = from.limb;
    }
    add_turn(group, std::move(turn));
  }

  void add_limb(const GroupPlan& from, ThesisGroup& group, int number) {
    const LimbPlan& limb = plan.limbs[to_size(number)];
    // The end of a limb can be part of the limb.
    const bool own_end =
        std::any_of(from.parts.begin(), from.parts.end(), [&](const PartPlan& part) {
          return part.kind == PartKind::kSegment && part.index == limb.end;
        });
    if (!own_end) add_segment(from, group, limb.end);
    group.steps.push_back({true, number});
    ThesisTurn lower;
    lower.joints = {limb.lower};
    lower.points = points_through(plan, lower.joints);
    // Targets whose range covers the whole limb use it analytically.
    std::erase_if(lower.points, [&](int k) { return plan.points[to_size(k)].limb >= 0; });
    lower.limb_of_hinge = number;
    lower.support_limb = number;
    add_turn(group, std::move(lower));
  }

  void add_group(const GroupPlan& from) {
    ThesisGroup group;
    for (const PartPlan& part : from.parts) {
      if (part.kind == PartKind::kLimb) {
        add_limb(from, group, part.index);
      } else if (part.kind == PartKind::kSection) {
        ThesisTurn turn;
        turn.joints = plan.sections[to_size(part.index)];
        turn.points = points_through(plan, turn.joints);
        group.is_trunk = true;
        add_turn(group, std::move(turn));
      } else {
        add_segment(from, group, part.index);
      }
    }
    out.groups.push_back(std::move(group));
  }

  // The pelvis rotates for its orientation only: positions use the translation of the
  // root.
  void add_root() {
    ThesisTurn turn;
    turn.joints = {0};
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      const PointPlan& point = plan.points[k];
      if (point.turns_only() && point.joint == 0) {
        turn.points.push_back(static_cast<int>(k));
      }
    }
    ThesisGroup group;
    group.is_trunk = true;
    add_turn(group, std::move(turn));
    out.groups.push_back(std::move(group));
  }

  [[nodiscard]] std::vector<int> users_of(const std::vector<int>& joints) const {
    std::vector<int> users;
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      const std::vector<int>& chain = plan.points[k].chain;
      const bool uses =
          std::any_of(joints.begin(), joints.end(), [&](int j) { return has(chain, j); });
      const bool holds = has(joints, plan.points[k].joint);
      if (uses || holds) users.push_back(static_cast<int>(k));
    }
    return users;
  }

  void add_balancing(const GroupPlan& from) {
    if (!from.balances || from.level == 1) return;
    KineticGroup group;
    group.limb = from.limb;
    if (from.limb >= 0) {
      const LimbPlan& limb = plan.limbs[to_size(from.limb)];
      group.root = limb.upper;
    } else {
      for (const int section : from.sections) {
        const std::vector<int>& joints = plan.sections[to_size(section)];
        group.joints.insert(group.joints.end(), joints.begin(), joints.end());
      }
      if (group.joints.empty()) group.joints = from.joints;
      std::sort(group.joints.begin(), group.joints.end());
      // A single chain; branches follow later.
      std::erase_if(group.joints,
                    [&](int j) { return !plan.is_at_or_below(group.joints.back(), j); });
      group.root = group.joints.front();
    }
    group.below = live_below(plan, group.root);
    group.users = users_of(from.joints);
    if (!group.below.empty()) out.balancing.push_back(std::move(group));
  }
};

// Order of trunk, legs, arms, head: by level, trunks first, then limbs, then groups
// without limbs.
int weight_class(const Plan& plan, const KineticGroup& group) {
  int level = 2;
  for (const GroupPlan& from : plan.groups) {
    if (has(from.joints, group.root)) level = from.level;
  }
  const bool trunk = group.limb < 0 && level == 2;
  return 4 * level + (trunk ? 0 : group.limb >= 0 ? 1 : 2);
}

}  // namespace

ThesisPlan make_thesis_plan(const Plan& plan) {
  ThesisPlanBuilder builder{plan, {}};
  for (const GroupPlan& group : plan.groups) {
    if (group.level != 1) builder.add_group(group);
  }
  builder.add_root();
  for (const GroupPlan& group : plan.groups) builder.add_balancing(group);
  ThesisPlan& out = builder.out;
  for (KineticGroup& group : out.balancing) group.rank = weight_class(plan, group);
  std::stable_sort(
      out.balancing.begin(),
      out.balancing.end(),
      [](const KineticGroup& a, const KineticGroup& b) { return a.rank < b.rank; });
  out.bone_orientations.resize(plan.limbs.size());
  out.supports.resize(plan.limbs.size());
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const bool support = point.goal == GoalKind::kSupport;
    out.moves_root.push_back(point.moves_root && !point.turns_only() && !support ? 1 : 0);
    if (point.limb < 0) continue;
    if (support) out.supports[to_size(point.limb)].push_back(static_cast<int>(k));
    if (point.turns_only() && !point.direct) {
      out.bone_orientations[to_size(point.limb)].push_back(static_cast<int>(k));
    }
  }
  return out;
}

}  // namespace marey::retarget
