// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/annotate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "edit/state/check_op_keys.h"
#include "edit/state/resolve_moment.h"
#include <glm/common.hpp>

#include "core/base/in_quotes.h"

namespace marey::edit {
namespace {

Status check_text(const std::string& text, const char* key) {
  if (!text.empty()) return Done{};
  return bad_input(key, "is empty", "state a text such as \"locomotion:walk\"");
}

void insert_note(Annotation note, Annotations& annotations) {
  const auto later = [](const Annotation& a, const Annotation& b) {
    return std::pair(a.start_s, a.text) < std::pair(b.start_s, b.text);
  };
  auto& notes = annotations.notes;
  notes.insert(std::upper_bound(notes.begin(), notes.end(), note, later), note);
}

/// Returns the value at a frame. Precondition: keys ascend by frame and are not empty.
double value_at(const std::vector<std::pair<double, double>>& keys, double frame) {
  if (frame <= keys.front().first) return keys.front().second;
  const auto after = std::lower_bound(
      keys.begin(),
      keys.end(),
      frame,
      [](const std::pair<double, double>& key, double at) { return key.first < at; });
  if (after == keys.end()) return keys.back().second;
  const auto before = std::prev(after);
  const double share = (frame - before->first) / (after->first - before->first);
  return glm::mix(before->second, after->second, share);
}

Result<std::vector<std::pair<double, double>>> curve_keys(const CurveOp& op,
                                                          const Timeline& timeline) {
  std::vector<std::pair<double, double>> keys;
  for (const CurveKey& key : op.keys) {
    const auto frame = resolve_moment(timeline, key.at);
    if (!frame) return frame.error();
    if (!std::isfinite(key.value)) {
      return bad_input("keys", "has a value that is not finite", "state a number");
    }
    if (!keys.empty() && *frame <= keys.back().first) {
      return bad_input("keys", "do not ascend in time", "sort them by time");
    }
    keys.emplace_back(*frame, key.value);
  }
  if (keys.empty()) return bad_input("keys", "is empty", "state at least one key");
  return keys;
}

}  // namespace

Status add_tag(const TagOp& op,
               const EditOp& common,
               const Timeline& timeline,
               Annotations& annotations) {
  if (const Status ok = check_op_keys(common, {.span = true}); !ok) return ok;
  if (const Status ok = check_text(op.text, "text"); !ok) return ok;
  const auto span = resolve_span(timeline, common.span);
  if (!span) return span.error();
  const double hz = timeline.rate_hz;
  insert_note({op.text, span->first / hz, span->last / hz}, annotations);
  return Done{};
}

Status add_event(const EventOp& op,
                 const EditOp& common,
                 const Timeline& timeline,
                 Annotations& annotations) {
  if (const Status ok = check_op_keys(common, {}); !ok) return ok;
  if (const Status ok = check_text(op.text, "text"); !ok) return ok;
  const auto frame = resolve_moment(timeline, op.at);
  if (!frame) return frame.error();
  const double time_s = *frame / timeline.rate_hz;
  insert_note({op.text, time_s, time_s}, annotations);
  return Done{};
}

Status add_curve(const CurveOp& op,
                 const EditOp& common,
                 const Timeline& timeline,
                 Annotations& annotations) {
  if (const Status ok = check_op_keys(common, {}); !ok) return ok;
  if (const Status ok = check_text(op.name, "name"); !ok) return ok;
  const auto keys = curve_keys(op, timeline);
  if (!keys) return keys.error();
  ValueCurve curve{op.name, {}};
  for (int frame = 0; frame < timeline.frame_count; ++frame) {
    curve.values.push_back(value_at(*keys, frame));
  }
  auto& curves = annotations.curves;
  const auto same = std::find_if(curves.begin(), curves.end(), [&](const ValueCurve& c) {
    return c.name == op.name;
  });
  if (same != curves.end()) {
    *same = std::move(curve);
  } else {
    curves.push_back(std::move(curve));
  }
  return Done{};
}

Result<EditState> apply_tag(const TagOp& op,
                            const OpContext& context,
                            EditState state,
                            OpReport& /*report*/) {
  const Status ok = add_tag(op, context.op, timeline_of(state), state.annotations);
  if (!ok) return ok.error();
  return state;
}

Result<EditState> apply_event(const EventOp& op,
                              const OpContext& context,
                              EditState state,
                              OpReport& /*report*/) {
  const Status ok = add_event(op, context.op, timeline_of(state), state.annotations);
  if (!ok) return ok.error();
  return state;
}

Result<EditState> apply_curve(const CurveOp& op,
                              const OpContext& context,
                              EditState state,
                              OpReport& /*report*/) {
  const Status ok = add_curve(op, context.op, timeline_of(state), state.annotations);
  if (!ok) return ok.error();
  return state;
}

}  // namespace marey::edit
