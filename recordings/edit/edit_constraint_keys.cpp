// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_constraint_keys.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include <glm/vec3.hpp>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/body/constraint_words.h"
#include "recordings/edit/edit_limits.h"
#include "recordings/edit/edit_rotation_keys.h"
#include "recordings/edit/edit_value_keys.h"

namespace marey::recordings::recipe {
namespace {

/// Keys of the goal of each type, in the order of kGoalElements.
constexpr std::array<std::array<std::string_view, 4>, kGoalElements.size()> kGoalKeys{{
    {"distance_m", "position_m"},
    {"distance_m", "other_segment", "other_offset_m"},
    {"distance_m", "other_constraint"},
    {"min_m", "max_m"},
    {"min_m", "max_m"},
    {"orientation_deg", "orientation_wxyz"},
    {"position_m", "orientation_deg", "orientation_wxyz", "turns"},
}};

glm::dvec3 read_vector(TomlReader& in, std::string_view key) {
  const std::vector<double> v = read_numbers(in, key, 3, kPlace);
  return {v[0], v[1], v[2]};
}

void write_vector(TomlWriter& out, std::string_view key, const glm::dvec3& v) {
  out.numbers(key, {v.x, v.y, v.z});
}

double read_goal_distance(TomlReader& in) {
  return in.has("distance_m") ? in.number("distance_m", kLength) : 0.0;
}

BodyPoint read_body_point(TomlReader& in,
                          std::string_view segment,
                          std::string_view offset) {
  BodyPoint point{read_line(in, segment, kMaxNameBytes), glm::dvec3(0.0)};
  if (in.has(offset)) point.offset_in_t_pose = read_vector(in, offset);
  return point;
}

void write_body_point(TomlWriter& out,
                      std::string_view segment,
                      std::string_view offset,
                      const BodyPoint& point) {
  out.text(segment, point.segment);
  if (point.offset_in_t_pose != glm::dvec3(0.0)) {
    write_vector(out, offset, point.offset_in_t_pose);
  }
}

void read_goal(TomlReader& in, DistanceToPoint& goal) {
  goal.distance_m = read_goal_distance(in);
  goal.p_in_world = read_vector(in, "position_m");
}

void read_goal(TomlReader& in, DistanceToBody& goal) {
  goal.distance_m = read_goal_distance(in);
  goal.other = read_body_point(in, "other_segment", "other_offset_m");
}

void read_goal(TomlReader& in, DistanceToConstraint& goal) {
  goal.distance_m = read_goal_distance(in);
  goal.other_id = read_line(in, "other_constraint", kMaxNameBytes);
}

template <class Space>
void read_box(TomlReader& in, Space& goal) {
  goal.min_in_world = read_vector(in, "min_m");
  goal.max_in_world = read_vector(in, "max_m");
}

void read_goal(TomlReader& in, AllowedSpace& goal) {
  read_box(in, goal);
}

void read_goal(TomlReader& in, ForbiddenSpace& goal) {
  read_box(in, goal);
}

void read_goal(TomlReader& in, SegmentOrientation& goal) {
  if (const auto rotation = read_rotation(in, "orientation")) {
    goal.world_from_t_pose = *rotation;
    return;
  }
  in.fail("",
          "the key \"orientation_deg\" is missing in the constraint",
          "add orientation_deg, or orientation_wxyz for a quaternion");
}

void read_goal(TomlReader& in, Support& goal) {
  if (in.has("position_m")) goal.footprint_in_world = read_vector(in, "position_m");
  goal.world_from_t_pose = read_rotation(in, "orientation");
  if (in.has("turns")) goal.turns = in.boolean("turns");
}

void write_goal_distance(TomlWriter& out, double distance_m) {
  if (distance_m != 0.0) out.number("distance_m", distance_m);
}

void write_goal(TomlWriter& out, const DistanceToPoint& goal) {
  write_goal_distance(out, goal.distance_m);
  write_vector(out, "position_m", goal.p_in_world);
}

void write_goal(TomlWriter& out, const DistanceToBody& goal) {
  write_goal_distance(out, goal.distance_m);
  write_body_point(out, "other_segment", "other_offset_m", goal.other);
}

void write_goal(TomlWriter& out, const DistanceToConstraint& goal) {
  write_goal_distance(out, goal.distance_m);
  out.text("other_constraint", goal.other_id);
}

template <class Space>
void write_box(TomlWriter& out, const Space& goal) {
  write_vector(out, "min_m", goal.min_in_world);
  write_vector(out, "max_m", goal.max_in_world);
}

void write_goal(TomlWriter& out, const AllowedSpace& goal) {
  write_box(out, goal);
}

void write_goal(TomlWriter& out, const ForbiddenSpace& goal) {
  write_box(out, goal);
}

void write_goal(TomlWriter& out, const SegmentOrientation& goal) {
  write_rotation(out, "orientation", goal.world_from_t_pose);
}

void write_goal(TomlWriter& out, const Support& goal) {
  if (goal.footprint_in_world) write_vector(out, "position_m", *goal.footprint_in_world);
  if (goal.world_from_t_pose) write_rotation(out, "orientation", *goal.world_from_t_pose);
  if (goal.turns) out.boolean("turns", true);
}

template <std::size_t... kType>
Goal goal_of(std::size_t type, std::index_sequence<kType...> /*types*/) {
  Goal goal;
  ((type == kType ? void(goal.emplace<kType>()) : void()), ...);
  return goal;
}

/// Reads the type of the constraint; nullopt after a mistake.
std::optional<std::size_t> read_type(TomlReader& in) {
  const std::string type = in.text("type");
  if (!in.ok()) return std::nullopt;
  const auto* const found = std::find(kGoalElements.begin(), kGoalElements.end(), type);
  if (found != kGoalElements.end()) {
    return static_cast<std::size_t>(found - kGoalElements.begin());
  }
  in.fail("type",
          "there is no type of constraint " + in_quotes(type),
          suggestion(type, kGoalElements));
  return std::nullopt;
}

/// Reads a start or stop: a time into `time_s`, anything else into `moment`.
void read_edge(TomlReader& in,
               std::string_view key,
               std::optional<double>& time_s,
               std::optional<Moment>& moment) {
  moment = read_moment(in, key);
  const auto* const time = moment ? std::get_if<AtTime>(&*moment) : nullptr;
  if (time == nullptr) return;
  time_s = time->time_s;
  moment.reset();
}

void write_edge(TomlWriter& out,
                std::string_view key,
                const std::optional<double>& time_s,
                const std::optional<Moment>& moment) {
  if (moment) {
    write_moment(out, key, *moment);
  } else if (time_s) {
    write_moment(out, key, AtTime{*time_s});
  }
}

void read_times(TomlReader& in, ConstrainOp& op) {
  Activation& activation = op.constraint->activation;
  read_edge(in, "start", activation.start_s, op.from);
  read_edge(in, "stop", activation.stop_s, op.to);
  if (in.has("start_duration_s")) {
    activation.start_duration_s = in.number("start_duration_s", kTime);
  }
  if (in.has("stop_duration_s")) {
    activation.stop_duration_s = in.number("stop_duration_s", kTime);
  }
  if (activation.start_s && activation.stop_s) {
    check_span(in, "start_s", {AtTime{*activation.start_s}, AtTime{*activation.stop_s}});
  }
  check_span(in, "start_frame", {op.from, op.to});
}

}  // namespace

std::vector<std::string> constraint_keys(std::size_t type) {
  MAREY_ASSERT(type < kGoalKeys.size());
  std::vector<std::string> keys{
      "type", "name", "segment", "offset_m", "priority", "accuracy_m", "range"};
  for (const char* edge : {"start", "stop"}) {
    for (std::string& key : moment_keys(edge)) keys.push_back(std::move(key));
  }
  keys.insert(keys.end(), {"start_duration_s", "stop_duration_s"});
  for (const std::string_view key : kGoalKeys[type]) {
    if (!key.empty()) keys.emplace_back(key);
  }
  return keys;
}

void read_constraint_keys(TomlReader in, ConstrainOp& op) {
  in.set_name("the constraint");
  const std::optional<std::size_t> type = read_type(in);
  if (!type) return;
  const std::vector<std::string> keys = constraint_keys(*type);
  in.allow(std::vector<std::string_view>(keys.begin(), keys.end()));
  Constraint& constraint = op.constraint.emplace();
  constraint.id = read_line(in, "name", kMaxNameBytes);
  constraint.point = read_body_point(in, "segment", "offset_m");
  if (in.has("priority")) constraint.importance = in.number("priority", kImportance);
  if (in.has("accuracy_m")) constraint.precision_m = in.number("accuracy_m", kLength);
  if (in.has("range")) constraint.range = in.integer("range", kSegmentRange);
  read_times(in, op);
  constraint.goal = goal_of(*type, std::make_index_sequence<kGoalElements.size()>{});
  std::visit([&](auto& goal) { read_goal(in, goal); }, constraint.goal);
}

void write_constraint_keys(TomlWriter& out, const ConstrainOp& op) {
  MAREY_ASSERT(op.constraint.has_value());
  const Constraint& constraint = *op.constraint;
  const Constraint defaults;
  const Activation& activation = constraint.activation;
  out.table({"op", "constraint"});
  out.text("type", kGoalElements[constraint.goal.index()]);
  out.text("name", constraint.id);
  write_body_point(out, "segment", "offset_m", constraint.point);
  if (constraint.importance != defaults.importance) {
    out.number("priority", constraint.importance);
  }
  if (constraint.precision_m != defaults.precision_m) {
    out.number("accuracy_m", constraint.precision_m);
  }
  if (constraint.range) out.integer("range", *constraint.range);
  write_edge(out, "start", activation.start_s, op.from);
  write_edge(out, "stop", activation.stop_s, op.to);
  if (activation.start_duration_s != 0.0) {
    out.number("start_duration_s", activation.start_duration_s);
  }
  if (activation.stop_duration_s != 0.0) {
    out.number("stop_duration_s", activation.stop_duration_s);
  }
  std::visit([&](const auto& goal) { write_goal(out, goal); }, constraint.goal);
}

}  // namespace marey::recordings::recipe
