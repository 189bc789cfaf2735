// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_carry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "edit/splice/splice_contacts.h"
#include "edit/state/constraint_copies.h"
#include "edit/state/resample_state.h"
#include <glm/common.hpp>

#include "core/base/assert.h"

namespace marey::edit {
namespace {

constexpr double kSameTime_s = 1e-9;
bool is_same_constraint(const Constraint& a, const Constraint& b) {
  return a.id == b.id && is_same_point(a.point, b.point) && is_same_goal(a.goal, b.goal);
}

bool lasts_beyond(const Activation& when, double time_s) {
  return !when.stop_s || *when.stop_s + when.stop_duration_s > time_s + kSameTime_s;
}

bool begins_before(const Activation& when, double time_s) {
  return !when.start_s || *when.start_s < time_s - kSameTime_s;
}

void delay(Activation& when, double time_s) {
  if (when.start_s) *when.start_s += time_s;
  if (when.stop_s) *when.stop_s += time_s;
}

// Instant of the join and the time over which constraints fade there. [s]
struct JoinTime {
  double at_s = 0.0;
  double fade_s = 0.0;
};

ConstraintSet joined_constraints(ConstraintSet set,
                                 const ConstraintSet& tail,
                                 const JoinTime& time) {
  std::vector<Constraint> added;
  std::map<std::string, std::string> renamed;
  for (Constraint constraint : tail.constraints) {
    delay(constraint.activation, time.at_s);
    const bool begins = !begins_before(constraint.activation, time.at_s) &&
                        constraint.activation.start_s &&
                        *constraint.activation.start_s > time.at_s + kSameTime_s;
    Constraint* same = set.find(constraint.id);
    if (!begins && same != nullptr && is_same_constraint(*same, constraint) &&
        (!same->activation.stop_s ||
         *same->activation.stop_s >= time.at_s - kSameTime_s)) {
      same->activation.stop_s = constraint.activation.stop_s;
      same->activation.stop_duration_s = constraint.activation.stop_duration_s;
      renamed[constraint.id] = constraint.id;
      continue;
    }
    if (begins_before(constraint.activation, time.at_s)) {
      constraint.activation.start_s = time.at_s - 0.5 * time.fade_s;
      constraint.activation.start_duration_s = time.fade_s;
    }
    added.push_back(std::move(constraint));
  }
  for (Constraint& constraint : set.constraints) {
    if (renamed.contains(constraint.id) ||
        !lasts_beyond(constraint.activation, time.at_s)) {
      continue;
    }
    constraint.activation.stop_s = time.at_s - 0.5 * time.fade_s;
    constraint.activation.stop_duration_s = time.fade_s;
  }
  const std::size_t count = set.constraints.size();
  for (Constraint& constraint : added) {
    const std::string id = free_constraint_id(set, constraint.id);
    renamed[constraint.id] = id;
    constraint.id = id;
    set.constraints.push_back(std::move(constraint));
  }
  for (std::size_t k = count; k < set.constraints.size(); ++k) {
    auto* to_other = std::get_if<DistanceToConstraint>(&set.constraints[k].goal);
    if (to_other == nullptr) continue;
    const auto name = renamed.find(to_other->other_id);
    if (name != renamed.end()) to_other->other_id = name->second;
  }
  for (const std::string& xml : tail.unknown_xml) {
    if (std::find(set.unknown_xml.begin(), set.unknown_xml.end(), xml) ==
        set.unknown_xml.end()) {
      set.unknown_xml.push_back(xml);
    }
  }
  return set;
}

std::vector<Annotation> joined_notes(std::vector<Annotation> notes,
                                     const std::vector<Annotation>& tail,
                                     double join_s) {
  const auto is_at_join = [&](double time_s) {
    return std::abs(time_s - join_s) < kSameTime_s;
  };
  for (Annotation note : tail) {
    note.start_s += join_s;
    note.end_s += join_s;
    const auto same = std::find_if(notes.begin(), notes.end(), [&](const Annotation& n) {
      return n.text == note.text && n.is_event() == note.is_event() &&
             is_at_join(n.end_s) && is_at_join(note.start_s);
    });
    if (same == notes.end()) {
      notes.push_back(std::move(note));
    } else if (!note.is_event()) {
      same->end_s = note.end_s;
    }
  }
  std::stable_sort(
      notes.begin(), notes.end(), [](const Annotation& a, const Annotation& b) {
        return std::tie(a.start_s, a.text) < std::tie(b.start_s, b.text);
      });
  return notes;
}

const ValueCurve* find_curve(const Annotations& annotations, const std::string& name) {
  for (const ValueCurve& curve : annotations.curves) {
    if (curve.name == name) return &curve;
  }
  return nullptr;
}

ValueCurve joined_curve(const std::string& name,
                        const EditState& first,
                        const EditState& second,
                        const JoinFrames& frames) {
  const ValueCurve* a = find_curve(first.annotations, name);
  const ValueCurve* b = find_curve(second.annotations, name);
  ValueCurve out{name, {}};
  const int count = frames.start + second.frame_count();
  for (int frame = 0; frame < count; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const double from = a != nullptr && t < a->values.size() ? a->values[t] : 0.0;
    if (frame < frames.start) {
      out.values.push_back(from);
      continue;
    }
    const auto k = static_cast<std::size_t>(frame - frames.start);
    const double to = b != nullptr ? b->values[k] : 0.0;
    double weight = k < frames.weight.size() ? frames.weight[k] : 1.0;
    if (frames.weight.size() < 2) weight = frame > frames.join ? 1.0 : 0.0;
    out.values.push_back(from == to ? to : glm::mix(from, to, weight));
  }
  return out;
}

std::vector<ValueCurve> joined_curves(const EditState& first,
                                      const EditState& second,
                                      const JoinFrames& frames) {
  std::vector<ValueCurve> out;
  for (const ValueCurve& curve : first.annotations.curves) {
    out.push_back(joined_curve(curve.name, first, second, frames));
  }
  for (const ValueCurve& curve : second.annotations.curves) {
    if (find_curve(first.annotations, curve.name) != nullptr) continue;
    out.push_back(joined_curve(curve.name, first, second, frames));
  }
  return out;
}

// Appends the frames of `tail` after its first one, which is the join.
void append_lineage(const Lineage& tail, Lineage& lineage) {
  const std::size_t offset = lineage.touches.size();
  for (LineageTouch entry : tail.touches) {
    if (entry.earlier) *entry.earlier += offset;
    lineage.touches.push_back(entry);
  }
  for (std::size_t t = 1; t < tail.frames.size(); ++t) {
    FrameLineage entry = tail.frames[t];
    if (entry.history) *entry.history += offset;
    lineage.frames.push_back(entry);
  }
}

void append_uncertainty(const EditState& tail, EditState& out, OpReport& report) {
  if (out.uncertainty.empty() != tail.uncertainty.empty()) {
    report.findings.push_back(fair_finding("uncertainty",
                                           "",
                                           "one of the motions has no uncertainty, so "
                                           "that of the other one is dropped"));
  }
  if (out.uncertainty.empty() || tail.uncertainty.empty()) {
    out.uncertainty.clear();
    return;
  }
  out.uncertainty.insert(
      out.uncertainty.end(), tail.uncertainty.begin() + 1, tail.uncertainty.end());
}

}  // namespace

EditState join_states(const EditState& first,
                      const EditState& second,
                      const JoinFrames& frames,
                      OpReport& report) {
  MAREY_ASSERT(frames.start <= frames.join && frames.join < first.frame_count());
  const int skipped = frames.join - frames.start;
  MAREY_ASSERT(skipped < second.frame_count());
  EditState out = slice_state(first, {0, frames.join});
  const EditState tail = slice_state(second, {skipped, second.frame_count() - 1});
  const double hz = first.motion.rate.hz;
  const JoinTime time{frames.join / hz,
                      static_cast<double>(frames.body.last - frames.body.first) / hz};
  out.motion.first_frame = first.motion.first_frame;
  out.motion.poses.insert(
      out.motion.poses.end(), tail.motion.poses.begin() + 1, tail.motion.poses.end());
  append_uncertainty(tail, out, report);
  append_lineage(tail.lineage, out.lineage);
  out.annotations.notes =
      joined_notes(std::move(out.annotations.notes), tail.annotations.notes, time.at_s);
  out.annotations.curves = joined_curves(first, second, frames);
  out.constraints =
      joined_constraints(std::move(out.constraints), tail.constraints, time);
  for (ContactEdit edit : tail.contact_edits) {
    edit.from_s += time.at_s;
    edit.to_s += time.at_s;
    out.contact_edits.push_back(edit);
  }
  out.contacts = join_contacts(first.contacts,
                               second.contacts,
                               {frames.start,
                                frames.join,
                                frames.body.last - frames.body.first,
                                hz,
                                frames.body.first});
  return out;
}

}  // namespace marey::edit
