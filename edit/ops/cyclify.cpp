// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/cyclify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "edit/find/find_loops.h"
#include "edit/ops/close_cycle.h"
#include "edit/ops/seam_acceleration.h"
#include "edit/splice/repeat_constraints.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"

#include "core/base/degrees.h"
#include "core/base/format_text.h"
#include "core/base/frame_range.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

constexpr double kMaxGap_legs = 0.15;
/// A joint this far off is worth a warning: a hand may be on the other side of the body.
constexpr double kMaxJointGap_legs = 0.35;
constexpr double kNearlyAsGood = 1.1;
constexpr int kMaxCycles = 10000;
constexpr double kMaxCycleFrames = 5e6;

Error bad_cyclify(std::string cause, std::string next) {
  return bad_input("motion", std::move(cause), std::move(next));
}

Status check_cyclify(const CyclifyOp& op, const EditOp& common, const EditState& state) {
  if (const Status keys = check_op_keys(common, {.span = true}); !keys) return keys;
  if (op.cycles < 1 || op.cycles > kMaxCycles) {
    return bad_cyclify("cycles is " + std::to_string(op.cycles),
                       "give a number from 1 to " + std::to_string(kMaxCycles));
  }
  if (op.from.has_value() != op.to.has_value()) {
    return bad_cyclify(op.from ? "cycle_from is given without cycle_to"
                               : "cycle_to is given without cycle_from",
                       "give both, or none for the best pair");
  }
  const double max_s = op.max_period_s.value_or(state.duration_s());
  const double min_s = op.min_period_s.value_or(0.0);
  if (min_s < 0.0 || max_s <= 0.0 || min_s > max_s || min_s > state.duration_s()) {
    return bad_cyclify(
        format_text("no cycle lasts from %.3f to %.3f s in %.3f s of motion",
                    min_s,
                    max_s,
                    state.duration_s()),
        "choose a period that the motion contains");
  }
  if (state.frame_count() < 4) {
    return bad_cyclify(std::to_string(state.frame_count()) + " frames are no cycle",
                       "use a motion that repeats itself");
  }
  return Done{};
}

/// The cycle to close, and how well its ends match.
struct ChosenCycle {
  CycleSpec spec;
  LoopCandidate loop;
};

/// A foot that stands on one footprint during the whole cycle.
bool has_fixed_foot(const EditState& state, const LoopCandidate& loop) {
  for (const auto& foot : state.contacts.feet) {
    for (const FrameRange& run : foot.stance) {
      if (run.first <= loop.first && run.last >= loop.last) return true;
    }
  }
  return false;
}

ChosenCycle chosen(const EditState& state, const CyclifyOp& op, LoopCandidate loop) {
  ChosenCycle out;
  out.spec.first = loop.first;
  out.spec.period_frames = std::min(
      loop.period_frames, static_cast<double>(state.frame_count() - 1 - loop.first));
  // Footprints of the next cycle are those of this one moved by the travel.
  if (!has_fixed_foot(state, loop)) out.spec.travel = loop.travel;
  out.spec.drift = op.drift;
  out.loop = std::move(loop);
  return out;
}

Result<ChosenCycle> given_cycle(const CyclifyOp& op, const EditState& state) {
  const auto from = resolve_moment(state, *op.from);
  if (!from) return from.error();
  const auto to = resolve_moment(state, *op.to);
  if (!to) return to.error();
  if (*to - *from < 2.0) {
    return bad_cyclify(
        format_text("cycle_from is frame %.1f and cycle_to is frame %.1f", *from, *to),
        "cycle_to must be at least 2 frames after cycle_from");
  }
  const int last = std::min(static_cast<int>(std::lround(*to)), state.frame_count() - 1);
  const int first = std::min(static_cast<int>(std::lround(*from)), last - 1);
  LoopCandidate loop = compare_loop(state, first, last);
  // The frames as given, not the nearest better ones.
  loop.period_frames = last - first;
  loop.travel = loop.match.a_from_b;
  return chosen(state, op, std::move(loop));
}

Error no_cycle(const EditState& state, const FindLoopsOptions& options) {
  const auto periods = loop_periods(state, options);
  if (!periods) {
    return bad_cyclify(
        "the feet do not repeat their movement, so the length of a cycle is unknown",
        "give min_period_s and max_period_s, or cycle_from and cycle_to");
  }
  return bad_cyclify(
      format_text("no two frames %.3f to %.3f s apart stand on the same feet",
                  periods->min_frames / state.motion.rate.hz,
                  periods->max_frames / state.motion.rate.hz),
      "widen min_period_s and max_period_s, or give cycle_from and cycle_to");
}

/// Returns the best candidate, or another one that is nearly as good if that has frames
/// on both sides over which the seam can be blended.
const LoopCandidate& best_with_room(const std::vector<LoopCandidate>& loops,
                                    const EditState& state) {
  const double room = CycleSpec{}.blend_s * state.motion.rate.hz + 1.0;
  for (const LoopCandidate& loop : loops) {
    if (loop.match.distance_m > kNearlyAsGood * loops.front().match.distance_m) break;
    if (loop.first >= room && loop.last + room < state.frame_count()) return loop;
  }
  return loops.front();
}

Result<ChosenCycle> best_cycle(const CyclifyOp& op,
                               const OpContext& context,
                               const EditState& state) {
  FindLoopsOptions options;
  options.min_period_s = op.min_period_s;
  options.max_period_s = op.max_period_s;
  if (!context.op.span.is_whole()) {
    const auto span = resolve_span(state, context.op.span);
    if (!span) return span.error();
    options.within = FrameRange{static_cast<int>(std::ceil(span->first - 1e-9)),
                                static_cast<int>(std::floor(span->last + 1e-9))};
    if (options.within->last - options.within->first < 2) {
      return bad_cyclify("the span has less than 3 frames", "choose a longer span");
    }
  }
  if (const Status ok = check_loop_search(state, options); !ok) return ok.error();
  const std::vector<LoopCandidate> loops = find_loops(state, options);
  if (loops.empty()) return no_cycle(state, options);
  return chosen(state, op, best_with_room(loops, state));
}

Status check_gap(const CyclifyOp& op, const EditState& state, const LoopCandidate& loop) {
  const double max_m = kMaxGap_legs * state.map.leg_length_m;
  if (op.force || loop.match.rms_m <= max_m) return Done{};
  return bad_cyclify(
      format_text("the motion is not cyclic: frames %d and %d differ by %.0f mm, above "
                  "0.15 leg lengths (%.0f mm)",
                  loop.first,
                  loop.last,
                  1e3 * loop.match.rms_m,
                  1e3 * max_m) +
          (op.from ? "" : "; they are the best pair"),
      "choose another period or other frames, or set force = true");
}

template <class Entry>
void repeat_entries(std::vector<Entry>& entries, int count) {
  const std::size_t once = entries.size();
  entries.reserve(once * static_cast<std::size_t>(count));
  for (int copy = 1; copy < count; ++copy) {
    for (std::size_t k = 0; k < once; ++k) entries.push_back(entries[k]);
  }
}

bool is_cycle_event(std::string_view text) {
  constexpr std::array<std::string_view, 5> kTexts{
      "left.strike", "left.toe_off", "right.strike", "right.toe_off", "loops"};
  return std::find(kTexts.begin(), kTexts.end(), text) != kTexts.end();
}

/// Events of one cycle, in which the first frame follows the last.
std::vector<Annotation> cycle_events(const Contacts& contacts, double hz) {
  std::vector<Annotation> out;
  const auto count = static_cast<std::size_t>(contacts.frame_count);
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string name = side == 0 ? "left" : "right";
    const std::vector<char> on = retarget::frame_marks(contacts.feet[side].stance, count);
    for (std::size_t t = 0; t < count; ++t) {
      if (!on[t]) continue;
      const double time_s = static_cast<double>(t) / hz;
      if (!on[(t + count - 1) % count]) out.push_back({name + ".strike", time_s, time_s});
      if (!on[(t + 1) % count]) out.push_back({name + ".toe_off", time_s, time_s});
    }
  }
  return out;
}

void repeat_notes(const std::vector<Annotation>& events,
                  double period_s,
                  int count,
                  EditState& state) {
  std::vector<Annotation> once = state.annotations.notes;
  std::erase_if(once, [](const Annotation& note) { return is_cycle_event(note.text); });
  once.insert(once.end(), events.begin(), events.end());
  std::vector<Annotation>& notes = state.annotations.notes;
  notes.clear();
  for (int copy = 0; copy < count; ++copy) {
    for (Annotation note : once) {
      note.start_s += copy * period_s;
      note.end_s += copy * period_s;
      notes.push_back(std::move(note));
    }
  }
  notes.push_back({"loops", 0.0, state.duration_s()});
  std::sort(notes.begin(), notes.end(), [](const Annotation& a, const Annotation& b) {
    return std::tie(a.start_s, a.text, a.end_s) < std::tie(b.start_s, b.text, b.end_s);
  });
}

/// Repeats everything that belongs to the cycle. `events` are those of one cycle.
void repeat_cycle(const PlanarMove& step,
                  const std::vector<Annotation>& events,
                  int count,
                  EditState& state) {
  const int frames = state.frame_count();
  const double period_s = frames / state.motion.rate.hz;
  repeat_entries(state.motion.poses, count);
  for (int copy = 1; copy < count; ++copy) {
    const PlanarMove move = power(step, copy);
    for (int k = 0; k < frames; ++k) {
      move_pose(move, state.motion.poses[static_cast<std::size_t>(copy * frames + k)]);
    }
  }
  repeat_entries(state.uncertainty, count);
  repeat_entries(state.lineage.frames, count);
  for (ValueCurve& curve : state.annotations.curves) repeat_entries(curve.values, count);
  state.contacts = repeat_contacts(state.contacts, count);
  state.constraints = repeat_constraints(state.constraints, step, period_s, count);
  const std::vector<ContactEdit> edits = state.contact_edits;
  for (int copy = 1; copy < count; ++copy) {
    for (ContactEdit edit : edits) {
      edit.from_s += copy * period_s;
      edit.to_s += copy * period_s;
      state.contact_edits.push_back(edit);
    }
  }
  repeat_notes(events, period_s, count, state);
}

void report_cycle(const ChosenCycle& chosen,
                  const ClosedCycle& closed,
                  double displaced_m,
                  const EditState& state,
                  OpReport& report) {
  const auto figure = [&](const char* name, double value) {
    report.figures.emplace_back(name, value);
  };
  const double hz = state.motion.rate.hz;
  const PlanarMatch& match = chosen.loop.match;
  const int frames = cycle_frames(chosen.spec);
  const SeamAcceleration seam = seam_acceleration(closed.cycle.motion, closed.step);
  const PlanarMove& travel = chosen.spec.travel;
  figure("first_frame", chosen.spec.first);
  figure("period_frames", chosen.spec.period_frames);
  figure("frames", frames);
  figure("period_s", frames / hz);
  figure("period_change_percent", 100.0 * (frames / chosen.spec.period_frames - 1.0));
  figure("gap_rms_mm", 1e3 * match.rms_m);
  figure("gap_worst_mm", 1e3 * match.worst_m);
  figure("velocity_gap_m_per_s", match.rms_velocity_m_per_s);
  figure("turn_deg", kDegreesPerRadian * travel.turn_rad);
  figure("travel_m", closed.travel_m);
  figure("seam_acceleration_m_per_s2", seam.seam);
  figure("inside_acceleration_p95_m_per_s2", seam.inside);
  figure("displaced_mm", 1e3 * displaced_m);
  figure("slide_mm", closed.plant.slide_after_mm);
  figure("unreachable_frames", closed.plant.unreachable_frames);
}

void report_cycle_findings(const ChosenCycle& chosen,
                           const ClosedCycle& closed,
                           const CyclifyOp& op,
                           const EditState& state,
                           OpReport& report) {
  const double max_m = kMaxJointGap_legs * state.map.leg_length_m;
  const PlanarMatch& match = chosen.loop.match;
  const std::size_t had = state.constraints.constraints.size();
  if (match.worst_m > max_m || match.rms_m > kMaxGap_legs * state.map.leg_length_m) {
    report.findings.push_back(
        fair_finding("loop_gap",
                     format_text("frames %d and %d", chosen.loop.first, chosen.loop.last),
                     format_text("a joint is %.0f mm apart at the ends of the cycle, all "
                                 "joints %.0f mm",
                                 1e3 * match.worst_m,
                                 1e3 * match.rms_m),
                     "choose other frames, or check the movement around the seam"));
    report.findings.back().measured(1e3 * match.worst_m, 1e3 * max_m, "mm");
  }
  const auto dropped = [&](int count, const char* cause, const char* next) {
    if (count == 0) return;
    report.findings.push_back(fair_finding(
        "constraints_dropped",
        "constraints",
        format_text("%d of %zu constraints were dropped: %s", count, had, cause),
        next));
  };
  dropped(closed.dropped.outside,
          "they are not active within the cycle",
          "choose a cycle that contains them, or add them after the loop is made");
  dropped(closed.dropped.in_place,
          "the body leaves their places, because it stays in place",
          "use another drift, or add constraints after the loop is made");
  if (op.drift == CycleDrift::kNone) {
    Finding note;
    note.id = "in_place";
    note.where = "motion";
    note.cause =
        "the body stays in place, so standing feet move backwards: the contacts were "
        "removed and stay as events";
    report.findings.push_back(std::move(note));
  }
}

}  // namespace

Result<EditState> apply_cyclify(const CyclifyOp& op,
                                const OpContext& context,
                                const EditState& state,
                                OpReport& report) {
  const Status status = check_cyclify(op, context.op, state);
  if (!status) return status.error();
  const auto chosen = op.from ? given_cycle(op, state) : best_cycle(op, context, state);
  if (!chosen) return chosen.error();
  const Status gap = check_gap(op, state, chosen->loop);
  if (!gap) return gap.error();
  if (op.cycles * static_cast<double>(cycle_frames(chosen->spec)) > kMaxCycleFrames) {
    return bad_cyclify(std::to_string(op.cycles) + " cycles of " +
                           std::to_string(cycle_frames(chosen->spec)) +
                           " frames are more than 5 million frames",
                       "give a smaller number of cycles");
  }
  ClosedCycle closed = close_cycle(state, chosen->spec);
  EditState out = std::move(closed.cycle);
  const FrameRange all{0, out.frame_count() - 1};
  const double displaced_m = mark_displaced(out, closed.source, all, context.index);
  closed.cycle.motion = out.motion;
  report_cycle(*chosen, closed, displaced_m, state, report);
  report_cycle_findings(*chosen, closed, op, state, report);
  repeat_cycle(
      closed.step, cycle_events(closed.contacts, out.motion.rate.hz), op.cycles, out);
  return out;
}

}  // namespace marey::edit
