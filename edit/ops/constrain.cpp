// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/constrain.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "edit/find/found_constraints.h"
#include "edit/state/adapt_state.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/constraint_copies.h"
#include "edit/state/full_time.h"
#include "edit/state/move_state.h"
#include "edit/state/resolve_moment.h"

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "retarget/constraints/check_constraints.h"

namespace marey::edit {
namespace {

/// The ends of an interval must be fully active despite rounding. [frames]
constexpr double kSlackFrames = 0.01;

Status check_objects(const ConstrainOp& op) {
  if (op.objects.empty()) return Done{};
  if (op.detect != DetectConstraints::kTouches) {
    return bad_input("objects",
                     "are used only by detect = \"touches\"",
                     "remove them, or detect touches");
  }
  std::set<std::string_view> names;
  for (const EditObject& object : op.objects) {
    const std::string where = "object " + in_quotes(object.name);
    if (object.name.empty()) {
      return bad_input("objects", "an object has no name", "name each object");
    }
    if (!names.insert(object.name).second) {
      return bad_input(where, "its name is used twice", "give each object its own name");
    }
    for (int axis = 0; axis < 3; ++axis) {
      // False for NaN.
      if (std::isfinite(object.min_in_world[axis]) &&
          std::isfinite(object.max_in_world[axis]) &&
          object.min_in_world[axis] <= object.max_in_world[axis]) {
        continue;
      }
      return bad_input(where,
                       "its min is above its max, or not finite",
                       "give the corners of the box in metres");
    }
  }
  return Done{};
}

Status check_wanted(const ConstrainOp& op, const OpContext& context) {
  if (!op.constraint && !op.detect && op.changes.empty() && !op.adapt) {
    return bad_input(
        "constrain",
        "has nothing to do",
        "give a constraint, detect = \"supports\" or \"touches\", changes, or "
        "adapt = true");
  }
  if (op.constraint && !op.changes.empty()) {
    return bad_input("changes",
                     "a constraint and changes of others are in one operation",
                     "use two operations");
  }
  if (op.constraint && op.detect) {
    return bad_input("detect",
                     "a constraint and a detection are in one operation",
                     "use two operations");
  }
  const bool has_constraint = op.constraint.has_value();
  const OpKeys keys{.span = has_constraint || op.detect.has_value(),
                    .blend = has_constraint};
  if (const Status ok = check_op_keys(context.op, keys); !ok) return ok.error();
  if (!has_constraint && (op.from || op.to)) {
    return bad_input("from",
                     "states the time of a constraint, and there is none",
                     "use a span to limit a detection");
  }
  return check_objects(op);
}

/// Sets the times of a constraint from the operation, if it states any.
Status resolve_times(const ConstrainOp& op,
                     const OpContext& context,
                     const EditState& state,
                     Constraint& constraint) {
  Activation& when = constraint.activation;
  if (when.start_duration_s == 0.0) when.start_duration_s = context.op.blend_s;
  if (when.stop_duration_s == 0.0) when.stop_duration_s = context.op.blend_s;
  EditSpan span{op.from, op.to};
  if (span.is_whole()) span = context.op.span;
  if (span.is_whole()) return Done{};
  const auto frames = resolve_span(state, span);
  if (!frames) return frames.error();
  const double hz = state.motion.rate.hz;
  if (span.from) {
    when.start_s = (frames->first - kSlackFrames) / hz - when.start_duration_s;
  }
  if (span.to) when.stop_s = (frames->last + kSlackFrames) / hz;
  return Done{};
}

/// Returns the detected constraint that an id means, also if it was changed by hand
/// before.
Constraint* detected_constraint(ConstraintSet& set, const std::string& id) {
  const std::string given(given_name(id));
  if (Constraint* found = set.find(std::string(kFoundPrefix) + given)) return found;
  return is_found(id) ? set.find(given) : nullptr;
}

Status place_constraint(const ConstrainOp& op, const OpContext& context, EditState& out) {
  Constraint placed = *op.constraint;
  if (Constraint* detected = detected_constraint(out.constraints, placed.id)) {
    const std::string given(given_name(placed.id));
    if (placed.point.segment.empty()) {
      Activation when = placed.activation;
      placed = *detected;
      if (when.start_duration_s > 0.0) {
        placed.activation.start_duration_s = when.start_duration_s;
      }
      if (when.stop_duration_s > 0.0) {
        placed.activation.stop_duration_s = when.stop_duration_s;
      }
      if (when.start_s) placed.activation.start_s = when.start_s;
      if (when.stop_s) placed.activation.stop_s = when.stop_s;
    }
    if (const Status ok = resolve_times(op, context, out, placed); !ok) return ok.error();
    placed.id = given;
    *detected = std::move(placed);
    return Done{};
  }
  if (out.constraints.find(placed.id) != nullptr) {
    return bad_input("constraint " + in_quotes(placed.id),
                     "an earlier operation has already placed a constraint of this id",
                     "give it another id, or remove the earlier operation");
  }
  if (is_found(placed.id)) {
    return bad_input("constraint " + in_quotes(placed.id),
                     "no detection has found a constraint of this id",
                     "detect before this operation, or use an id without \"found\"");
  }
  if (const Status ok = resolve_times(op, context, out, placed); !ok) return ok.error();
  out.constraints.constraints.push_back(std::move(placed));
  return Done{};
}

bool is_support(const Constraint& constraint) {
  return std::holds_alternative<Support>(constraint.goal);
}

/// Sets the times of a constraint from a change by hand.
Status change_times(const ConstraintChange& change,
                    const EditState& state,
                    Constraint& constraint) {
  Activation& when = constraint.activation;
  // The fully active part keeps its edges while a fade is changed alone.
  const FullTime full = full_time(when);
  if (change.start_duration_s) {
    when.start_duration_s = *change.start_duration_s;
    if (when.start_s) when.start_s = full.from_s - when.start_duration_s;
  }
  if (change.stop_duration_s) when.stop_duration_s = *change.stop_duration_s;
  const double hz = state.motion.rate.hz;
  if (change.start) {
    if (const auto* const time = std::get_if<AtTime>(&*change.start)) {
      when.start_s = time->time_s;
    } else {
      const auto frame = resolve_moment(state, *change.start);
      if (!frame) return frame.error();
      when.start_s = (*frame - kSlackFrames) / hz - when.start_duration_s;
    }
  }
  if (change.stop) {
    if (const auto* const time = std::get_if<AtTime>(&*change.stop)) {
      when.stop_s = time->time_s;
    } else {
      const auto span = resolve_span(state, {std::nullopt, *change.stop});
      if (!span) return span.error();
      when.stop_s = (span->last + kSlackFrames) / hz;
    }
  }
  return Done{};
}

/// Returns the supports of one stance: those of the same foot that take over from each
/// other, from the heel to the ball.
std::vector<Constraint*> stance_of(Constraint& support, ConstraintSet& set) {
  constexpr double kTakesOver_s = 0.05;
  std::vector<Constraint*> out{&support};
  for (std::size_t k = 0; k < out.size(); ++k) {
    const FullTime at = full_time(out[k]->activation);
    for (Constraint& other : set.constraints) {
      const auto* goal = std::get_if<Support>(&other.goal);
      if (goal == nullptr || !goal->footprint_in_world ||
          other.point.segment != support.point.segment ||
          std::find(out.begin(), out.end(), &other) != out.end()) {
        continue;
      }
      FullTime its = full_time(other.activation);
      its.from_s -= kTakesOver_s;
      its.to_s += kTakesOver_s;
      if (overlap(at, its)) out.push_back(&other);
    }
  }
  return out;
}

/// Applies one change by hand. A detected constraint loses the word "found", and the
/// other supports of its stance lose it too if the footprint moves.
Status change_constraint(const ConstraintChange& change, EditState& out) {
  ConstraintSet& set = out.constraints;
  const std::string where = "the change of " + in_quotes(change.name);
  Constraint* constraint = set.find(change.name);
  if (constraint == nullptr) constraint = detected_constraint(set, change.name);
  if (constraint == nullptr) {
    std::vector<std::string_view> names;
    for (const Constraint& c : set.constraints) names.emplace_back(c.id);
    return bad_input(where,
                     "the motion has no constraint of this name",
                     names.empty() ? "detect or add it before this operation"
                                   : suggestion(change.name, names));
  }
  std::vector<Constraint*> changed{constraint};
  if (change.p_in_world) {
    const auto place = target_in_world(constraint->goal);
    if (!place) {
      return bad_input(where,
                       "it has position_m, and the constraint has no place in the world",
                       "remove position_m");
    }
    if (is_support(*constraint)) changed = stance_of(*constraint, set);
    RigidTransform move;
    move.translation = *change.p_in_world - *place;
    for (Constraint* each : changed) move_constraint(move, *each);
  }
  if (const Status ok = change_times(change, out, *constraint); !ok) return ok.error();
  for (Constraint* each : changed) {
    if (is_found(each->id)) each->id = free_constraint_id(set, given_name(each->id));
  }
  return Done{};
}

/// Returns true if a constraint changed by hand stands for this one.
bool is_changed_by_hand(const Constraint& found, const ConstraintSet& set) {
  return std::any_of(
      set.constraints.begin(), set.constraints.end(), [&](const Constraint& other) {
        return !is_found(other.id) && other.point.segment == found.point.segment &&
               family_name(other.id) == family_name(found.id) &&
               overlap(full_time(other.activation), full_time(found.activation));
      });
}

/// Removes the constraints of this operation that contradict others.
Status drop_contradictions(const Character& character,
                           std::set<std::string>& added,
                           ConstraintSet& set,
                           OpReport& report) {
  while (true) {
    const Status ok = retarget::check_constraints(set, character);
    if (ok) return Done{};
    const auto named = std::find_if(added.begin(), added.end(), [&](const auto& id) {
      return ok.error().where == "constraint \"" + id + "\"";
    });
    if (named == added.end()) return ok.error();
    report.findings.push_back(fair_finding("contradiction",
                                           ok.error().where,
                                           "it was left out: " + ok.error().cause,
                                           "correct the contacts at that time"));
    std::erase_if(set.constraints, [&](const Constraint& c) { return c.id == *named; });
    added.erase(named);
  }
}

Status replace_found(const ConstrainOp& op,
                     const OpContext& context,
                     const Character& character,
                     EditState& out,
                     OpReport& report) {
  const auto span = resolve_span(out, context.op.span);
  if (!span) return span.error();
  const double hz = out.motion.rate.hz;
  FullTime wanted = full_time({});
  if (context.op.span.from) wanted.from_s = span->first / hz;
  if (context.op.span.to) wanted.to_s = span->last / hz;
  const bool supports = *op.detect == DetectConstraints::kSupports;
  ConstraintSet& set = out.constraints;
  std::erase_if(set.constraints, [&](const Constraint& c) {
    return is_found(c.id) && is_support(c) == supports &&
           overlap(full_time(c.activation), wanted);
  });
  std::set<std::string> added;
  int changed_by_hand = 0;
  for (Constraint& found :
       supports ? found_supports(out) : found_touches(out, op.objects)) {
    if (!overlap(full_time(found.activation), wanted)) continue;
    if (is_changed_by_hand(found, set)) {
      ++changed_by_hand;
      continue;
    }
    found.id = free_constraint_id(set, found.id);
    added.insert(found.id);
    set.constraints.push_back(std::move(found));
  }
  if (const Status ok = drop_contradictions(character, added, set, report); !ok) {
    return ok.error();
  }
  report.figures.emplace_back("found", static_cast<double>(added.size()));
  report.figures.emplace_back("changed_by_hand", changed_by_hand);
  return Done{};
}

}  // namespace

Result<EditState> apply_constrain(const ConstrainOp& op,
                                  const OpContext& context,
                                  const EditState& state,
                                  OpReport& report) {
  if (const Status ok = check_wanted(op, context); !ok) return ok.error();
  const auto character = character_of(state);
  if (!character) return character.error();
  EditState out = state;
  if (op.constraint) {
    if (const Status ok = place_constraint(op, context, out); !ok) return ok.error();
  }
  if (op.detect) {
    const Status ok = replace_found(op, context, *character, out, report);
    if (!ok) return ok.error();
  }
  for (const ConstraintChange& change : op.changes) {
    if (const Status ok = change_constraint(change, out); !ok) return ok.error();
  }
  if (const Status ok = retarget::check_constraints(out.constraints, *character); !ok) {
    return ok.error();
  }
  if (!op.adapt) {
    report.figures.emplace_back("constraints",
                                static_cast<double>(out.constraints.constraints.size()));
    return out;
  }
  if (const Status ok = adapt_state(out, report); !ok) return ok.error();
  return out;
}

}  // namespace marey::edit
