// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/cycle_constraints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/find/found_constraints.h"
#include "edit/state/constraint_copies.h"
#include "edit/state/full_time.h"
#include "edit/state/move_state.h"

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::edit {
namespace {

constexpr double kSameTime_s = 1e-9;

bool has_place(const Goal& goal) {
  return std::holds_alternative<DistanceToPoint>(goal) ||
         std::holds_alternative<AllowedSpace>(goal) ||
         std::holds_alternative<ForbiddenSpace>(goal) ||
         std::holds_alternative<Support>(goal);
}

const std::string* other_of(const Constraint& constraint) {
  const auto* goal = std::get_if<DistanceToConstraint>(&constraint.goal);
  return goal == nullptr ? nullptr : &goal->other_id;
}

/// Removes distances to constraints that are not in the set. Returns their number.
int remove_orphans(ConstraintSet& set) {
  int removed = 0;
  while (true) {
    const auto count = std::erase_if(set.constraints, [&](const Constraint& c) {
      const std::string* other = other_of(c);
      return other != nullptr && set.find(*other) == nullptr;
    });
    if (count == 0) return removed;
    removed += static_cast<int>(count);
  }
}

template <class Test>
int remove_constraints(ConstraintSet& set, const Test& test) {
  const auto removed = std::erase_if(set.constraints, test);
  return static_cast<int>(removed) + remove_orphans(set);
}

/// Returns the frame of a point of the body, turned as its segment is against the T-pose.
std::optional<RigidTransform> point_in_world(const EditState& state,
                                             const Pose& pose,
                                             const BodyPoint& point) {
  const Skeleton& skeleton = state.motion.skeleton;
  const auto joint = retarget::resolve_segment(skeleton, point.segment);
  if (!joint) return std::nullopt;
  const RigidTransform world_from_joint =
      world_from_joints(skeleton, pose)[index(*joint)];
  const glm::dquat turn =
      world_from_joint.rotation *
      glm::conjugate(state.map.joints[index(*joint)].t_pose_from_joint);
  return RigidTransform{turn,
                        world_from_joint.translation + turn * point.offset_in_t_pose};
}

/// Returns that part of a time that the motion has.
FullTime within(const FullTime& full, const EditState& state) {
  return {std::max(full.from_s, 0.0),
          std::min(full.to_s, state.frame_count() / state.motion.rate.hz)};
}

std::size_t frame_at(double time_s, const EditState& state) {
  const double frame = std::round(time_s * state.motion.rate.hz);
  return static_cast<std::size_t>(std::clamp(frame, 0.0, state.frame_count() - 1.0));
}

std::size_t middle_frame(const FullTime& full, const EditState& state) {
  const FullTime part = within(full, state);
  return frame_at(0.5 * (part.from_s + part.to_s), state);
}

/// Returns the mean of point_in_world() over the middle half of a time: noise averages
/// out, and a foot that lands or leaves does not count.
std::optional<RigidTransform> resting_point(const EditState& state,
                                            const FullTime& full,
                                            const BodyPoint& point) {
  const FullTime part = within(full, state);
  const double quarter_s = 0.25 * (part.to_s - part.from_s);
  const std::size_t first = frame_at(part.from_s + quarter_s, state);
  const std::size_t last = std::max(first, frame_at(part.to_s - quarter_s, state));
  glm::dvec3 place(0.0);
  glm::dquat turn(0.0, 0.0, 0.0, 0.0);
  for (std::size_t t = first; t <= last; ++t) {
    const auto at = point_in_world(state, state.motion.poses[t], point);
    if (!at) return std::nullopt;
    place += at->translation / static_cast<double>(last - first + 1);
    const bool is_opposite = glm::dot(turn, at->rotation) < 0.0;
    turn = turn + (is_opposite ? -at->rotation : at->rotation);
  }
  return RigidTransform{glm::normalize(turn), place};
}

/// Returns the time in which a point stands on one footprint, under all the supports that
/// share it, such as those of a heel strike and of the flat foot.
FullTime print_time(const Constraint& constraint, const ConstraintSet& set) {
  const auto& print = std::get<Support>(constraint.goal).footprint_in_world;
  FullTime out = full_time(constraint.activation);
  for (const Constraint& other : set.constraints) {
    const auto* support = std::get_if<Support>(&other.goal);
    if (support == nullptr || !print || support->footprint_in_world != print ||
        !is_same_point(other.point, constraint.point)) {
      continue;
    }
    const FullTime full = full_time(other.activation);
    out = {std::min(out.from_s, full.from_s), std::max(out.to_s, full.to_s)};
  }
  return out;
}

/// Postures of one cycle before and after it was closed.
struct CycleMove {
  const EditState& source;
  std::span<const PlanarMove> moves;  ///< By frame of the cycle.
  const Motion& moved;                ///< The source's postures after these moves.
  const EditState& cycle;
  /// Supports that detection finds in both.
  std::vector<Constraint> source_supports;
  std::vector<Constraint> cycle_supports;
};

/// Returns the support of the same point that detection finds at that time, if any.
const Support* detected_support(const Constraint& constraint,
                                const std::vector<Constraint>& detected) {
  const bool turns = std::get<Support>(constraint.goal).turns;
  const FullTime full = full_time(constraint.activation);
  const Support* best = nullptr;
  double longest_s = 0.0;
  for (const Constraint& other : detected) {
    const auto* support = std::get_if<Support>(&other.goal);
    if (support == nullptr || support->turns != turns ||
        !is_same_point(other.point, constraint.point)) {
      continue;
    }
    const FullTime at = full_time(other.activation);
    const double common_s =
        std::min(full.to_s, at.to_s) - std::max(full.from_s, at.from_s);
    if (best != nullptr && common_s <= longest_s) continue;
    if (common_s < 0.0) continue;
    best = support;
    longest_s = common_s;
  }
  return best;
}

/// Returns the place and rotation at which a foot stands during a support, as detection
/// finds them; otherwise the foot's own.
std::optional<RigidTransform> standing_place(const EditState& state,
                                             const Constraint& constraint,
                                             const std::vector<Constraint>& detected) {
  auto out = resting_point(state, full_time(constraint.activation), constraint.point);
  const Support* found = detected_support(constraint, detected);
  if (!out || found == nullptr) return out;
  if (found->footprint_in_world) out->translation = *found->footprint_in_world;
  if (found->world_from_t_pose) out->rotation = *found->world_from_t_pose;
  return out;
}

/// Moves a support from where its foot stands in the source to where it stands in the
/// cycle. `was` is the same constraint of the source.
void move_support(const CycleMove& move,
                  const Constraint& was,
                  const FullTime& print,
                  Constraint& constraint) {
  auto& support = std::get<Support>(constraint.goal);
  const auto stood = standing_place(move.source, was, move.source_supports);
  const auto stands = standing_place(move.cycle, constraint, move.cycle_supports);
  if (!stood || !stands) return;
  if (support.footprint_in_world) {
    const glm::dquat turn = move.moves[middle_frame(print, move.cycle)].rotation();
    support.footprint_in_world =
        stands->translation + turn * (*support.footprint_in_world - stood->translation);
  }
  if (support.world_from_t_pose) {
    support.world_from_t_pose = glm::normalize(
        stands->rotation * glm::conjugate(stood->rotation) * *support.world_from_t_pose);
  }
}

/// Gives supports that shared a footprint in the source the same one in the cycle.
void share_footprints(const ConstraintSet& before, ConstraintSet& after) {
  const auto print = [](const Constraint& c) -> std::optional<glm::dvec3> {
    const auto* support = std::get_if<Support>(&c.goal);
    return support == nullptr ? std::nullopt : support->footprint_in_world;
  };
  for (std::size_t k = 0; k < before.constraints.size(); ++k) {
    const Constraint& c = before.constraints[k];
    for (std::size_t i = 0; print(c) && i < k; ++i) {
      const Constraint& other = before.constraints[i];
      if (print(other) != print(c) || !is_same_point(other.point, c.point)) continue;
      std::get<Support>(after.constraints[k].goal).footprint_in_world =
          print(after.constraints[i]);
      break;
    }
  }
}

void move_with_cycle(const CycleMove& move, Constraint& constraint) {
  const std::size_t t = middle_frame(full_time(constraint.activation), move.cycle);
  move_constraint(move.moves[t].transform(), constraint);
  auto* const goal = std::get_if<DistanceToPoint>(&constraint.goal);
  if (goal == nullptr) return;
  const auto from = point_in_world(move.cycle, move.moved.poses[t], constraint.point);
  const auto to =
      point_in_world(move.cycle, move.cycle.motion.poses[t], constraint.point);
  if (from && to) goal->p_in_world += to->translation - from->translation;
}

}  // namespace

DroppedConstraints carry_constraints(const EditState& source,
                                     std::span<const PlanarMove> moves,
                                     const Motion& moved,
                                     bool in_place,
                                     EditState& cycle) {
  MAREY_ASSERT(moves.size() == moved.poses.size());
  MAREY_ASSERT(moves.size() == cycle.motion.poses.size());
  ConstraintSet& set = cycle.constraints;
  const double period_s = cycle.frame_count() / cycle.motion.rate.hz;
  DroppedConstraints dropped;
  dropped.outside =
      static_cast<int>(source.constraints.constraints.size() - set.constraints.size());
  dropped.outside += remove_constraints(set, [&](const Constraint& c) {
    const FullTime full = full_time(c.activation);
    return full.from_s >= period_s - kSameTime_s || full.to_s < -kSameTime_s;
  });
  if (in_place) {
    dropped.in_place =
        remove_constraints(set, [](const Constraint& c) { return has_place(c.goal); });
  }
  CycleMove move{source, moves, moved, cycle, {}, {}};
  const bool has_support =
      std::any_of(set.constraints.begin(), set.constraints.end(), [](const auto& c) {
        return std::holds_alternative<Support>(c.goal);
      });
  if (has_support) {
    move.source_supports = found_supports(source);
    move.cycle_supports = found_supports(cycle);
  }
  ConstraintSet out = set;
  for (Constraint& constraint : out.constraints) {
    if (std::holds_alternative<Support>(constraint.goal)) {
      move_support(move,
                   *source.constraints.find(constraint.id),
                   print_time(constraint, set),
                   constraint);
    } else {
      move_with_cycle(move, constraint);
    }
  }
  share_footprints(set, out);
  set = std::move(out);
  return dropped;
}

}  // namespace marey::edit
