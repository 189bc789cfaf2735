// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/plan/adapt_plan.h"

#include <algorithm>
#include <functional>

#include "core/base/assert.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::retarget {
namespace {

int number(JointIndex joint) {
  return static_cast<int>(index(joint));
}

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int joint_named(const Character& character, std::string_view segment) {
  const auto joint = resolve_segment(character.skeleton, segment);
  MAREY_ASSERT(joint.has_value());
  return number(*joint);
}

GoalKind kind_of(const Goal& goal) {
  struct Kind {
    GoalKind operator()(const DistanceToPoint&) { return GoalKind::kDistanceToPoint; }
    GoalKind operator()(const DistanceToBody&) { return GoalKind::kDistanceToOther; }
    GoalKind operator()(const DistanceToConstraint&) {
      return GoalKind::kDistanceToOther;
    }
    GoalKind operator()(const AllowedSpace&) { return GoalKind::kAllowedSpace; }
    GoalKind operator()(const ForbiddenSpace&) { return GoalKind::kForbiddenSpace; }
    GoalKind operator()(const SegmentOrientation&) { return GoalKind::kOrientation; }
    GoalKind operator()(const Support&) { return GoalKind::kSupport; }
  };
  return std::visit(Kind{}, goal);
}

bool is_at_joint(const Constraint& c) {
  const glm::dvec3& o = c.point.offset_in_t_pose;
  return o.x == 0.0 && o.y == 0.0 && o.z == 0.0;
}

void add_groups(const Character& character, Plan& plan) {
  for (const BodyGroup& group : character.groups) {
    GroupPlan out;
    out.level = group.level;
    out.balances = group.balances;
    for (const BodyPart& part : group.parts) {
      for (const JointIndex j : part.joints) out.joints.push_back(number(j));
      if (part.kind == PartKind::kLimb) {
        LimbPlan limb;
        limb.upper = number(part.joints[0]);
        limb.lower = number(part.joints[1]);
        limb.end = number(part.joints[2]);
        limb.can_support = group.can_support;
        out.limb = static_cast<int>(plan.limbs.size());
        out.parts.push_back({part.kind, out.limb});
        plan.limb_of_hinge[at(limb.lower)] = out.limb;
        plan.limbs.push_back(std::move(limb));
      } else if (part.kind == PartKind::kSection) {
        std::vector<int> vertebrae;
        for (const JointIndex j : part.joints) vertebrae.push_back(number(j));
        out.sections.push_back(static_cast<int>(plan.sections.size()));
        out.parts.push_back({part.kind, out.sections.back()});
        plan.sections.push_back(std::move(vertebrae));
      } else {
        for (const JointIndex j : part.joints) {
          out.parts.push_back({part.kind, number(j)});
        }
      }
    }
    plan.groups.push_back(std::move(out));
  }
}

// Removes joints that carry both points: they do not change the distance between them.
void leave_shared_out(const Plan& plan, PointPlan& point) {
  std::erase_if(point.chain,
                [&](int j) { return plan.is_at_or_below(point.other_joint, j); });
  point.moves_root = false;
  if (!point.chain.empty()) point.top = point.chain.back();
}

// `at_joint`: the point is at its joint.
void place_on_limb(Plan& plan, bool at_joint, PointPlan& point) {
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const LimbPlan& limb = plan.limbs[l];
    if (!plan.is_at_or_below(point.joint, limb.upper)) continue;
    if (!plan.is_at_or_below(limb.upper, point.top)) continue;
    point.limb = static_cast<int>(l);
    point.place = LimbPlace::kUpper;
    // The elbow itself belongs to the upper bone.
    const bool elbow = point.joint == limb.lower && at_joint;
    if (plan.is_at_or_below(point.joint, limb.lower) && !elbow) {
      point.place = LimbPlace::kLower;
    }
    if (plan.is_at_or_below(point.joint, limb.end)) point.place = LimbPlace::kExtremity;
  }
}

// Returns for every joint if it belongs to a part of the table. Others (fingers, twist
// bones) are rigid.
std::vector<char> joints_of_groups(const Plan& plan) {
  std::vector<char> in_group(at(plan.joint_count), 0);
  for (const GroupPlan& group : plan.groups) {
    for (const int j : group.joints) in_group[at(j)] = 1;
  }
  in_group[0] = 1;
  return in_group;
}

void add_points(const Character& character,
                const ConstraintSet& constraints,
                Plan& plan) {
  const std::vector<char> in_group = joints_of_groups(plan);
  std::vector<double> ranks;
  for (const Constraint& c : constraints.constraints) {
    if (!std::holds_alternative<Support>(c.goal)) ranks.push_back(c.importance);
  }
  std::sort(ranks.begin(), ranks.end(), std::greater<>());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  plan.level_count = static_cast<int>(ranks.size());

  for (std::size_t i = 0; i < constraints.constraints.size(); ++i) {
    const Constraint& c = constraints.constraints[i];
    PointPlan point;
    point.constraint = static_cast<int>(i);
    point.joint = joint_named(character, c.point.segment);
    point.goal = kind_of(c.goal);
    if (const auto* body = std::get_if<DistanceToBody>(&c.goal)) {
      point.other_joint = joint_named(character, body->other.segment);
    } else if (const auto* other = std::get_if<DistanceToConstraint>(&c.goal)) {
      point.other_joint =
          joint_named(character, constraints.find(other->other_id)->point.segment);
    }
    if (const auto* to_point = std::get_if<DistanceToPoint>(&c.goal)) {
      point.at_distance = to_point->distance_m > 0.0;
    }
    const bool support = point.goal == GoalKind::kSupport;
    point.stands_flat = support && !std::get<Support>(c.goal).turns;
    if (!support) {
      const auto rank = std::find(ranks.begin(), ranks.end(), c.importance);
      point.level = 1 + static_cast<int>(rank - ranks.begin());
    }
    int left = support ? plan.joint_count : c.range.value_or(plan.joint_count);
    point.moves_root = false;
    for (int j = point.joint; j >= 0 && left > 0; j = plan.parent[at(j)]) {
      if (!in_group[at(j)] && j != point.joint) continue;
      --left;
      point.top = j;
      if (in_group[at(j)]) point.chain.push_back(j);
      if (j == 0) point.moves_root = true;
    }
    if (point.other_joint >= 0) leave_shared_out(plan, point);
    place_on_limb(plan, is_at_joint(c), point);
    point.direct = point.turns_only() && point.limb >= 0 &&
                   point.joint == plan.limbs[at(point.limb)].end;
    plan.points.push_back(std::move(point));
  }
  std::stable_sort(
      plan.points.begin(), plan.points.end(), [](const PointPlan& a, const PointPlan& b) {
        return a.level < b.level;
      });
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    if (point.limb >= 0) {
      LimbPlan& limb = plan.limbs[at(point.limb)];
      if (!point.turns_only()) limb.points.push_back(static_cast<int>(k));
      if (point.direct || point.stands_flat) {
        limb.orientations.push_back(static_cast<int>(k));
      }
    }
  }
}

// Finds the points on feet with supports. A foot with an orientation is fixed completely,
// another one at the supporting joint.
void find_firm_points(const ConstraintSet& constraints, Plan& plan) {
  const auto is_at_its_joint = [&](const PointPlan& point) {
    return is_at_joint(constraints.constraints[at(point.constraint)]);
  };
  for (PointPlan& point : plan.points) {
    if (point.level == 0 || point.goal == GoalKind::kDistanceToOther) continue;
    for (std::size_t k = 0; k < plan.points.size() && plan.points[k].level == 0; ++k) {
      const PointPlan& support = plan.points[k];
      if (support.limb < 0) continue;
      const int end = plan.limbs[at(support.limb)].end;
      const bool flat = support.stands_flat && support.joint == end &&
                        plan.is_at_or_below(point.joint, end);
      const bool same = support.joint == point.joint && !point.turns_only() &&
                        is_at_its_joint(support) && is_at_its_joint(point);
      if (flat || same) point.firm_under.push_back(static_cast<int>(k));
    }
  }
}

// Removes rotations without effect: a point at its joint is not moved by this joint.
void drop_idle_turns(const ConstraintSet& constraints, Plan& plan) {
  for (PointPlan& point : plan.points) {
    const Constraint& c = constraints.constraints[at(point.constraint)];
    if (!is_at_joint(c) || point.turns_only() || point.chain.size() < 2) continue;
    if (point.chain.front() == point.joint) point.chain.erase(point.chain.begin());
  }
}

void set_turning(Plan& plan, bool balance) {
  plan.turning.assign(at(plan.joint_count), Turning::kRigid);
  plan.turns_from.assign(at(plan.joint_count), 0);
  // The most important come first.
  for (const PointPlan& point : plan.points) {
    for (const int j : point.chain) {
      if (plan.turning[at(j)] != Turning::kRigid) continue;
      plan.turning[at(j)] =
          plan.limb_of_hinge[at(j)] >= 0 ? Turning::kHinge : Turning::kBall;
      plan.turns_from[at(j)] = point.level;
    }
  }
  for (const GroupPlan& group : plan.groups) {
    if (!balance || !group.balances) continue;
    for (const int j : group.joints) {
      const bool last =
          group.limb >= 0 && plan.is_at_or_below(j, plan.limbs[at(group.limb)].end);
      if (last) continue;
      plan.turns_from[at(j)] = 0;
      if (plan.turning[at(j)] != Turning::kRigid) continue;
      plan.turning[at(j)] =
          plan.limb_of_hinge[at(j)] >= 0 ? Turning::kHinge : Turning::kBall;
    }
  }
  plan.turning[0] = Turning::kBall;
  plan.turns_from[0] = 0;
}

void set_live(Plan& plan) {
  plan.is_live.assign(at(plan.joint_count), 0);
  const auto touch = [&](int j) {
    for (; j >= 0 && !plan.is_live[at(j)]; j = plan.parent[at(j)]) {
      plan.is_live[at(j)] = 1;
    }
  };
  touch(0);
  for (int j = 0; j < plan.joint_count; ++j) {
    if (plan.turning[at(j)] != Turning::kRigid) touch(j);
  }
  for (const PointPlan& point : plan.points) {
    touch(point.joint);
    if (point.other_joint >= 0) touch(point.other_joint);
  }
  // The thesis' method rotates a section as a whole.
  for (const std::vector<int>& section : plan.sections) {
    if (plan.turning[at(section.front())] != Turning::kRigid) touch(section.back());
  }
  for (const LimbPlan& limb : plan.limbs) touch(limb.end);
  if (plan.has_hamstrings()) touch(plan.abdomen_high);
  for (int j = 0; j < plan.joint_count; ++j) {
    (plan.is_live[at(j)] ? plan.live : plan.rest).push_back(j);
  }
  plan.in_limb.assign(at(plan.joint_count), 0);
  for (LimbPlan& limb : plan.limbs) {
    for (const int j : plan.live) {
      const bool on_the_way = plan.is_at_or_below(limb.end, j);
      const bool past = plan.is_at_or_below(j, limb.end);
      if (plan.is_at_or_below(j, limb.upper) && (on_the_way || past)) {
        limb.own.push_back(j);
        plan.in_limb[at(j)] = 1;
      }
      if (j > limb.upper && j < limb.lower && plan.is_at_or_below(limb.lower, j) &&
          plan.is_at_or_below(j, limb.upper)) {
        limb.between_upper.push_back(j);
      }
      if (j > limb.lower && j < limb.end && plan.is_at_or_below(limb.end, j) &&
          plan.is_at_or_below(j, limb.lower)) {
        limb.between_lower.push_back(j);
      }
      if (j != limb.end && plan.is_at_or_below(j, limb.end)) limb.beyond.push_back(j);
    }
  }
}

// Finds the lower section of the trunk, from its first vertebra to the first of the next
// section; in a trunk with one section to its last vertebra.
void find_abdomen(const Character& character, Plan& plan) {
  if (character.flexibility.min_trunk_thigh_angle_rad <= 0.0) return;
  for (const GroupPlan& group : plan.groups) {
    if (group.level != 2 || group.sections.empty()) continue;
    const std::vector<int>& low = plan.sections[at(group.sections.front())];
    const int high = group.sections.size() > 1
                         ? plan.sections[at(group.sections[1])].front()
                         : low.back();
    if (high == low.front()) continue;
    plan.abdomen_low = low.front();
    plan.abdomen_high = high;
    return;
  }
}

void set_shared(Plan& plan) {
  const int n = static_cast<int>(plan.points.size());
  plan.shared.assign(at(n * n), {});
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b) {
      const PointPlan& pa = plan.points[at(a)];
      const PointPlan& pb = plan.points[at(b)];
      SharedChain& shared = plan.shared[at(a * n + b)];
      shared.root = pa.moves_root && pb.moves_root;
      // Parents come first, so the first common member is the lowest.
      for (const int j : pa.chain) {
        if (std::find(pb.chain.begin(), pb.chain.end(), j) == pb.chain.end()) continue;
        if (shared.lowest < 0) shared.lowest = j;
        shared.above = plan.parent[at(j)];
      }
    }
  }
}

void set_through(Plan& plan) {
  for (int j = 0; j < plan.joint_count; ++j) {
    plan.through_begin.push_back(static_cast<int>(plan.through.size()));
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      const std::vector<int>& chain = plan.points[k].chain;
      if (std::find(chain.begin(), chain.end(), j) != chain.end()) {
        plan.through.push_back(static_cast<int>(k));
      }
    }
  }
  plan.through_begin.push_back(static_cast<int>(plan.through.size()));
}

void add_masses(const Character& character, Plan& plan) {
  const auto add = [&](const PointMass& mass) {
    int carrier = number(mass.joint);
    while (!plan.is_live[at(carrier)]) carrier = plan.parent[at(carrier)];
    plan.masses.push_back({number(mass.joint), carrier});
  };
  for (const PointMass& mass : character.masses) add(mass);
  plan.own_masses = plan.masses.size();
  for (const Load& load : character.loads) add(load.mass);
}

}  // namespace

Plan make_plan(const Character& character,
               const ConstraintSet& constraints,
               bool balance) {
  Plan plan;
  plan.joint_count = static_cast<int>(character.skeleton.joints.size());
  for (const Joint& joint : character.skeleton.joints) {
    plan.parent.push_back(joint.parent ? number(*joint.parent) : -1);
  }
  plan.limb_of_hinge.assign(at(plan.joint_count), -1);
  add_groups(character, plan);
  add_points(character, constraints, plan);
  find_firm_points(constraints, plan);
  drop_idle_turns(constraints, plan);
  for (const PointPlan& point : plan.points) {
    plan.has_supports = plan.has_supports || point.goal == GoalKind::kSupport;
  }
  find_abdomen(character, plan);
  set_turning(plan, balance);
  set_live(plan);
  set_shared(plan);
  set_through(plan);
  add_masses(character, plan);
  plan.limit_of.assign(at(plan.joint_count), -1);
  for (std::size_t i = 0; i < character.limits.size(); ++i) {
    plan.limit_of[index(character.limits[i].joint)] = static_cast<int>(i);
    plan.limited.push_back(number(character.limits[i].joint));
    plan.has_limits = true;
  }
  return plan;
}

}  // namespace marey::retarget
