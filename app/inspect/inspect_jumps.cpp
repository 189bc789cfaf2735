// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_jumps.h"

#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "app/motion/jump_figures.h"
#include "app/shell/findings.h"
#include "core/base/format_text.h"
#include "core/source.h"

namespace marey::app {
namespace {

using JumpJson = nlohmann::ordered_json;

/// Rounds to micrometres and microseconds, so that the list can be read.
JumpJson rounded_json(double value) {
  return std::round(value * 1e6) / 1e6;
}

const char* start_word(dynamics::PushStart start) {
  switch (start) {
    case dynamics::PushStart::kStanding:
      return "standing";
    case dynamics::PushStart::kTouchdown:
      return "touch-down";
    case dynamics::PushStart::kMoving:
      return "moving";
    case dynamics::PushStart::kClipStart:
      return "start of the clip";
    case dynamics::PushStart::kGiven:
      return "given";
  }
  return "unknown";
}

JumpJson jump_object(const dynamics::Jump& jump, int number) {
  const auto& end = jump.touchdown;
  const auto xz = [](const glm::dvec3& p) { return glm::dvec2(p.x, p.z); };
  const auto null_or = [&](double value) {
    return end ? rounded_json(value) : JumpJson();
  };
  const double airtime_s = end ? end->time_s - jump.takeoff.time_s : 0.0;
  const auto& landing = jump.landing_feet_in_world;
  return {
      {"number", number},
      {"starts_from", start_word(jump.start_kind)},
      {"start_s", rounded_json(jump.start.time_s)},
      {"lowest_s", rounded_json(jump.lowest_s)},
      {"takeoff_s", rounded_json(jump.takeoff.time_s)},
      {"apex_s", rounded_json(jump.apex_s)},
      {"touchdown_s", null_or(end ? end->time_s : 0.0)},
      {"rest_s", jump.rest ? rounded_json(jump.rest->time_s) : JumpJson()},
      {"rest_is_takeoff", jump.rest_is_takeoff},
      {"airtime_s", null_or(airtime_s)},
      {"rise_m", rounded_json(jump.rise_m())},
      {"takeoff_m_s", rounded_json(jump.takeoff.velocity_m_s.y)},
      {"length_m",
       landing ? rounded_json(glm::distance(xz(jump.takeoff_feet_in_world), xz(*landing)))
               : JumpJson()},
      {"fall_m_s2", rounded_json(jump.fall_m_s2)},
      {"flight_rms_mm", rounded_json(1e3 * jump.flight_rms_m)},
      {"takeoff_source", name(jump.takeoff_source)},
      {"touchdown_source", end ? JumpJson(name(jump.landing_source)) : JumpJson()},
      {"findings", findings_json(findings_of_jump_number(jump, number))}};
}

std::string seconds_text(const JumpJson& value) {
  return value.is_null() ? "after the end" : format_text("%.3f s", value.get<double>());
}

std::string jump_line(const JumpJson& jump) {
  std::string line = "push " + seconds_text(jump["start_s"]) + ", take-off " +
                     seconds_text(jump["takeoff_s"]) + ", touch-down " +
                     seconds_text(jump["touchdown_s"]) + ", rest " +
                     seconds_text(jump["rest_s"]);
  if (!jump["airtime_s"].is_null()) {
    line += ", " + seconds_text(jump["airtime_s"]) + " in the air";
  }
  return line + format_text(", rise %.3f m, acceleration in flight %.1f m/s^2",
                            jump["rise_m"].get<double>(),
                            jump["fall_m_s2"].get<double>());
}

}  // namespace

JumpJson jumps_json(std::span<const dynamics::Jump> jumps) {
  JumpJson out = JumpJson::array();
  int number = 0;
  for (const dynamics::Jump& jump : jumps) {
    out.push_back(jump_object(jump, ++number));
  }
  return out;
}

JumpJson jumps_as_lines(JumpJson inspected) {
  if (!inspected.contains("jumps") || inspected["jumps"].empty()) return inspected;
  JumpJson lines = JumpJson::object();
  for (const JumpJson& jump : inspected["jumps"]) {
    const std::string number = std::to_string(jump["number"].get<int>());
    lines[number] = jump_line(jump);
    int finding_number = 0;
    for (const JumpJson& finding : jump["findings"]) {
      lines[number + " finding " + std::to_string(++finding_number)] =
          finding["cause"].get<std::string>();
    }
  }
  inspected["jumps"] = std::move(lines);
  return inspected;
}

}  // namespace marey::app
