// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_jump.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/edit/edit_output_json.h"

namespace marey::app {
namespace {

using JumpJson = nlohmann::ordered_json;

/// Returns a number with `per_unit` steps in its unit; null: not finite.
JumpJson rounded_json(double value, double per_unit) {
  if (!std::isfinite(value)) return {};
  return std::round(value * per_unit) / per_unit;
}

JumpJson time_json(double time_s) {
  return rounded_json(time_s, 1e5);
}
JumpJson height_json(double height_m) {
  return rounded_json(height_m, 1e5);
}

JumpJson curve_json(const std::vector<double>& values, double per_unit) {
  JumpJson out = JumpJson::array();
  for (const double value : values) out.push_back(rounded_json(value, per_unit));
  return out;
}

const char* rule_name(dynamics::PushRule rule) {
  switch (rule) {
    case dynamics::PushRule::kForce:
      return "force";
    case dynamics::PushRule::kFall:
      return "fall";
    case dynamics::PushRule::kRise:
      return "rise";
  }
  return "force";
}

const char* source_name_of_jump(Source source) {
  return source == Source::kMeasured ? "measured" : "inferred";
}

JumpJson state_time_json(const std::optional<dynamics::ComState>& state) {
  return state ? time_json(state->time_s) : JumpJson();
}

JumpJson found_json(const dynamics::Jump& jump) {
  const double push_s = jump.takeoff.time_s - jump.start.time_s;
  return {{"start_s", time_json(jump.start.time_s)},
          {"takeoff_s", time_json(jump.takeoff.time_s)},
          {"apex_s", time_json(jump.apex_s)},
          {"landing_s", state_time_json(jump.touchdown)},
          {"end_s", state_time_json(jump.rest)},
          {"airtime_s",
           jump.touchdown ? time_json(jump.touchdown->time_s - jump.takeoff.time_s)
                          : JumpJson()},
          {"rise_m", height_json(jump.rise_m())},
          {"fall_m_s2", rounded_json(jump.fall_m_s2, 1e3)},
          {"lowest_at",
           push_s > 0.0 ? rounded_json((jump.lowest_s - jump.start.time_s) / push_s, 1e4)
                        : JumpJson()},
          {"lowest_m", height_json(jump.lowest_m)},
          {"takeoff", source_name_of_jump(jump.takeoff_source)},
          {"landing", source_name_of_jump(jump.landing_source)},
          {"findings", page_findings_json(jump.findings)}};
}

JumpJson space_json(const std::vector<dynamics::SpaceColumn>& space) {
  JumpJson out = JumpJson::array();
  for (const dynamics::SpaceColumn& column : space) {
    const auto& [low, high] = column.heights;
    out.push_back({rounded_json(column.lowest_at, 1e5),
                   height_json(low.height_m),
                   height_json(high.height_m),
                   rule_name(low.rule),
                   rule_name(high.rule)});
  }
  return out;
}

JumpJson phases_json(const edit::JumpGraph& graph) {
  if (!graph.refusal.empty()) return {};
  return {{"start_s", time_json(graph.start_s)},
          {"lowest_s", time_json(graph.lowest_s)},
          {"takeoff_s", time_json(graph.takeoff_s)},
          {"apex_s", time_json(graph.apex_s)},
          {"landing_s", time_json(graph.landing_s)},
          {"end_s", time_json(graph.end_s)}};
}

}  // namespace

Result<edit::JumpGraph> jump_graph_of(const EditRecipe& recipe,
                                      int op,
                                      const edit::EditInputs& inputs,
                                      const edit::EditState& state) {
  const auto index = static_cast<std::size_t>(op);
  const auto* jump = op >= 0 && index < recipe.ops.size()
                         ? std::get_if<JumpOp>(&recipe.ops[index].parameters)
                         : nullptr;
  if (jump == nullptr) {
    return bad_input("the edit",
                     "operation " + std::to_string(op + 1) + " is not a jump",
                     "choose an operation jump");
  }
  return edit::jump_graph(*jump, {recipe.ops[index], op, inputs}, state);
}

std::string jump_json(const EditAsker& asker, const EditJump& jump) {
  const edit::JumpGraph& graph = jump.graph;
  JumpJson jumps = JumpJson::array();
  for (const dynamics::Jump& one : graph.jumps) jumps.push_back(found_json(one));
  JumpJson lowest;
  if (!graph.space.empty()) {
    lowest = {{"at", rounded_json(graph.space_lowest_at, 1e5)},
              {"height_m", height_json(graph.space_lowest_m)}};
  }
  const JumpJson out{
      {"type", "jump"},
      {"id", asker.id},
      {"revision", jump.revision},
      {"op", jump.op},
      {"output", jump.output},
      {"number", jump.number},
      {"jumps", std::move(jumps)},
      {"refusal", graph.refusal},
      {"time_s", curve_json(graph.time_s, 1e5)},
      {"height_m", curve_json(graph.height_m, 1e5)},
      {"captured_height_m", curve_json(graph.captured_height_m, 1e5)},
      {"push_g", curve_json(graph.push_g, 1e4)},
      {"captured_push_g", curve_json(graph.captured_push_g, 1e4)},
      {"phases", phases_json(graph)},
      {"strength_g",
       graph.strength_g > 0.0 ? rounded_json(graph.strength_g, 1e4) : JumpJson()},
      {"space", space_json(graph.space)},
      {"lowest", std::move(lowest)}};
  return out.dump(-1, ' ', false, JumpJson::error_handler_t::replace);
}

}  // namespace marey::app
