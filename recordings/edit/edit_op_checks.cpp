// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_op_checks.h"

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/edit/edit_value_keys.h"

namespace marey::recordings::recipe {
namespace {

/// Mistake: none of the keys is there.
void need_one_of(TomlReader& in, std::initializer_list<std::string_view> keys) {
  std::string list;
  for (const std::string_view key : keys) {
    if (in.has(key)) return;
    list.append(list.empty() ? "" : ", ").append(key);
  }
  in.fail(
      "", "a key is missing: " + list, keys.size() == 1 ? "add it" : "add one of them");
}

/// Mistake: both keys are there.
void exclude(TomlReader& in, std::string_view a, std::string_view b) {
  if (!in.has(a) || !in.has(b)) return;
  in.fail(b, in_quotes(a) + " and " + in_quotes(b) + " exclude each other", "remove one");
}

void fail_order(TomlReader& in, std::string_view key) {
  in.fail(key,
          in_quotes(key) + " does not ascend",
          "give each instant once, the earlier one first");
}

template <class Row>
void check_ascending(TomlReader& in, std::string_view key, const std::vector<Row>& rows) {
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (is_later(rows[k - 1].at, rows[k].at) || rows[k - 1].at == rows[k].at) {
      fail_order(in, key);
    }
  }
}

template <class T>
void check_op(TomlReader& /*in*/, T& /*op*/) {}

void check_op(TomlReader& in, KeepOp& op) {
  if (op.spans.empty()) need_one_of(in, {"spans"});
  for (const EditSpan& span : op.spans) check_span(in, "spans", span);
}

void check_op(TomlReader& in, SplitOp& op) {
  if (op.at.empty()) need_one_of(in, {"instants"});
  for (std::size_t k = 1; k < op.at.size(); ++k) {
    if (is_later(op.at[k - 1], op.at[k]) || op.at[k - 1] == op.at[k]) {
      fail_order(in, "instants");
    }
  }
}

void check_op(TomlReader& in, FilterOp& op) {
  const bool is_spline = op.method == FilterMethod::kGcvSpline;
  for (const std::string_view key : {"cutoff", "cutoff_hz"}) {
    if (!is_spline || !in.has(key)) continue;
    in.fail(key,
            in_quotes(key) + " is for the Butterworth filter only",
            "add method = \"butterworth\", or remove it");
  }
  if (!is_spline && in.has("order")) {
    in.fail("order", "\"order\" is for the spline only", "remove it");
  }
  const bool has_rule = in.has("cutoff");
  if (in.has("cutoff_hz") && !has_rule) op.cutoff = CutoffRule::kGiven;
  const bool is_given = op.cutoff == CutoffRule::kGiven;
  if (is_given && !in.has("cutoff_hz")) need_one_of(in, {"cutoff_hz"});
  if (!is_given) exclude(in, "cutoff", "cutoff_hz");
}

void check_op(TomlReader& in, PlaceOp& /*op*/) {
  need_one_of(in, {"position_xz_m", "heading_deg"});
}

void check_op(TomlReader& in, PathOp& op) {
  exclude(in, "points_xz_m", "turn_deg");
  exclude(in, "points_xz_m", "length");
  exclude(in, "points_xz_m", "straight");
  if (op.points_xz_m.size() == 1) {
    in.fail("points_xz_m", "the path has one point", "give two or more");
  }
}

void check_op(TomlReader& in, RetimeOp& op) {
  need_one_of(in, {"knots", "speed", "duration_s", "rate_hz"});
  exclude(in, "knots", "speed");
  exclude(in, "knots", "duration_s");
  exclude(in, "speed", "duration_s");
  check_ascending(in, "knots", op.knots);
  for (std::size_t k = 1; k < op.knots.size(); ++k) {
    if (!(op.knots[k].time_s > op.knots[k - 1].time_s)) fail_order(in, "knots");
  }
}

void check_op(TomlReader& in, CyclifyOp& op) {
  if (op.min_period_s && op.max_period_s && *op.min_period_s > *op.max_period_s) {
    in.fail("max_period_s",
            "\"max_period_s\" is less than \"min_period_s\"",
            "exchange them");
  }
  const EditSpan cycle{op.from, op.to};
  if (cycle.from && cycle.to && is_later(*cycle.from, *cycle.to)) {
    in.fail("", "the cycle ends before it starts", "exchange its two ends");
  }
}

void check_op(TomlReader& in, ContactsOp& op) {
  need_one_of(in, {"detect", "edits"});
  for (const ContactEdit& edit : op.edits) {
    const bool is_span =
        edit.kind == ContactEdit::Kind::kSet || edit.kind == ContactEdit::Kind::kClear;
    if (is_span) check_span(in, "edits", {AtTime{edit.from_s}, AtTime{edit.to_s}});
  }
}

void check_changes(TomlReader& in, const std::vector<ConstraintChange>& changes) {
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const ConstraintChange& change = changes[k];
    const bool has_change = change.start || change.stop || change.start_duration_s ||
                            change.stop_duration_s || change.p_in_world;
    if (!has_change) {
      in.fail("changes",
              "the change of " + in_quotes(change.name) + " changes nothing",
              "give start, stop, start_duration_s, stop_duration_s or position_m");
    }
    check_span(in, "changes", {change.start, change.stop});
    for (std::size_t other = 0; other < k; ++other) {
      if (changes[other].name != change.name) continue;
      in.fail("changes",
              "there are two changes of " + in_quotes(change.name),
              "give one change per constraint");
    }
  }
}

void check_op(TomlReader& in, ConstrainOp& op) {
  need_one_of(in, {"constraint", "detect", "changes", "adapt"});
  exclude(in, "constraint", "detect");
  exclude(in, "constraint", "changes");
  check_changes(in, op.changes);
  const bool is_touch = op.detect == DetectConstraints::kTouches;
  if (is_touch && op.objects.empty()) need_one_of(in, {"objects"});
  if (!is_touch && in.has("objects")) {
    in.fail("objects", "\"objects\" is for touches only", "add detect = \"touches\"");
  }
  for (std::size_t k = 0; k < op.objects.size(); ++k) {
    const EditObject& object = op.objects[k];
    for (int axis = 0; axis < 3; ++axis) {
      if (object.min_in_world[axis] <= object.max_in_world[axis]) continue;
      in.fail("objects",
              in_quotes(object.name) + " has a min_m above its max_m",
              "give the lesser coordinates first");
    }
    for (std::size_t other = 0; other < k; ++other) {
      if (op.objects[other].name != object.name) continue;
      in.fail("objects",
              "two objects have the name " + in_quotes(object.name),
              "give each a name of its own");
    }
  }
}

void check_op(TomlReader& in, PoseOp& /*op*/) {
  need_one_of(in, {"moved_m", "rotation_deg", "rotation_wxyz"});
}

void check_op(TomlReader& in, OffsetOp& /*op*/) {
  need_one_of(in, {"moved_m", "rotation_deg", "rotation_wxyz"});
}

void check_op(TomlReader& in, ExaggerateOp& op) {
  if (op.high_hz == 0.0 || op.high_hz > op.low_hz) return;
  in.fail("high_hz",
          "\"high_hz\" is not above \"low_hz\"",
          "give the lower frequency as low_hz, or leave high_hz out");
}

void check_op(TomlReader& in, JumpOp& op) {
  exclude(in, "apex_m", "apex_by_m");
  exclude(in, "land_m", "length_m");
  exclude(in, "land_m", "box_m");
  if (in.has("lowest") && op.law != EditPushLaw::kThesis) {
    in.fail("lowest",
            "\"lowest\" is for the law \"thesis\" only",
            "add law = \"thesis\", or remove it");
  }
}

void check_op(TomlReader& in, CurveOp& op) {
  if (op.keys.empty()) need_one_of(in, {"keys"});
  check_ascending(in, "keys", op.keys);
}

}  // namespace

void check_op_keys(TomlReader& in, EditOpParameters& parameters) {
  if (!in.ok()) return;
  std::visit([&](auto& op) { check_op(in, op); }, parameters);
}

EditOpParameters without_idle_values(const EditOpParameters& parameters) {
  EditOpParameters out = parameters;
  if (auto* const filter = std::get_if<FilterOp>(&out)) {
    const FilterOp defaults;
    if (filter->method == FilterMethod::kGcvSpline) filter->cutoff = defaults.cutoff;
    if (filter->method != FilterMethod::kGcvSpline) filter->order = defaults.order;
    if (filter->cutoff != CutoffRule::kGiven) filter->cutoff_hz = defaults.cutoff_hz;
  }
  auto* const path = std::get_if<PathOp>(&out);
  if (path && !path->points_xz_m.empty()) *path = PathOp{path->points_xz_m};
  return out;
}

}  // namespace marey::recordings::recipe
