// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_engine.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "app/engine/base_json.h"
#include "app/engine/open_base.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/engine/scene.h"
#include "recordings/scene/read_scene.h"
#include "recordings/scene/read_trials.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using EngineJson = nlohmann::ordered_json;

/// Words of the alternatives of TargetPath, in their order.
constexpr std::array<std::string_view, std::variant_size_v<TargetPath>> kPathWords{
    "fixed", "lissajous", "polyline", "body"};

/// Returns the clip of a deed; empty: it has none.
struct ClipOf {
  std::string operator()(const SceneStop& /*deed*/) const { return {}; }
  std::string operator()(const SceneFollow& /*deed*/) const { return {}; }
  std::string operator()(const SceneCarry& /*deed*/) const { return {}; }
  std::string operator()(const SceneConstrain& /*deed*/) const { return {}; }
  template <class Deed>
  std::string operator()(const Deed& deed) const {
    return deed.clip;
  }
};

EngineJson text_or_null(const std::string& text) {
  return text.empty() ? EngineJson() : EngineJson(text);
}

EngineJson action_json(const SceneAction& action) {
  return {{"id", text_or_null(action.id)},
          {"body", action.body},
          {"do", kSceneDeeds[action.deed.index()]},
          {"clip", text_or_null(std::visit(ClipOf{}, action.deed))},
          {"target", text_or_null(target_of(action))},
          {"time_s", action.time_s},
          {"after", text_or_null(action.after)},
          {"event", text_or_null(action.event)}};
}

std::string clip_line(const EngineJson& clip) {
  std::string line = format_text("%.2f s, %.6g Hz, %d phases, %.2f m/s",
                                 clip["seconds"].get<double>(),
                                 clip["rate_hz"].get<double>(),
                                 clip["phases"].get<int>(),
                                 clip["speed_m_s"].get<double>());
  if (clip["loops"].get<bool>()) line += ", loops";
  for (const EngineJson& tag : clip["tags"]) line += ", " + tag.get<std::string>();
  return line;
}

std::string action_line(const EngineJson& action) {
  std::string line =
      action["body"].get<std::string>() + ": " + action["do"].get<std::string>();
  for (const char* key : {"clip", "target"}) {
    if (action[key].is_null()) continue;
    line += std::string(", ") + key + " " + in_quotes(action[key].get<std::string>());
  }
  if (action["after"].is_null()) {
    return line + format_text(", at %g s", action["time_s"].get<double>());
  }
  line += ", after " + in_quotes(action["after"].get<std::string>());
  if (action["event"].is_null()) return line;
  return line + " at its event " + in_quotes(action["event"].get<std::string>());
}

}  // namespace

Result<EngineJson> inspect_base(const fs::path& file) {
  const auto base = open_base(file);
  if (!base) return base.error();
  EngineJson out{{"kind", "base"}};
  out.update(base_json(**base));
  return out;
}

Result<EngineJson> inspect_scene(const fs::path& file) {
  const auto scene = recordings::read_scene(file);
  if (!scene) return scene.error();
  EngineJson bodies = EngineJson::array();
  for (const SceneBody& body : scene_bodies(*scene)) bodies.push_back(body.id);
  EngineJson targets = EngineJson::array();
  for (const SceneTarget& target : scene->targets) {
    targets.push_back({{"id", target.id},
                       {"path", kPathWords[target.path.index()]},
                       {"drag", target.drag}});
  }
  EngineJson actions = EngineJson::array();
  for (const SceneAction& action : scene->script) actions.push_back(action_json(action));
  return EngineJson{{"kind", "scene"},
                    {"name", scene->name},
                    {"duration_s", scene->duration_s},
                    {"base", scene->base},
                    {"bodies", std::move(bodies)},
                    {"targets", std::move(targets)},
                    {"actions", std::move(actions)},
                    {"figures", scene->figures.size()}};
}

Result<EngineJson> inspect_trials(const fs::path& file) {
  const auto list = recordings::read_trials(file);
  if (!list) return list.error();
  return EngineJson{{"kind", "trials"},
                    {"name", list->name},
                    {"trials", list->trials.size()},
                    {"throws", trial_order(*list).size()}};
}

EngineJson engine_as_lines(EngineJson inspected) {
  const EngineJson kind = inspected.value("kind", EngineJson());
  const auto replace = [&](const char* key, auto name_of, auto line_of) {
    EngineJson lines = EngineJson::object();
    std::size_t number = 0;
    for (const EngineJson& item : inspected[key])
      lines[name_of(++number, item)] = line_of(item);
    inspected[key] = std::move(lines);
  };
  if (kind == "base") {
    replace(
        "clips",
        [](std::size_t /*number*/, const EngineJson& clip) {
          return clip["name"].get<std::string>();
        },
        clip_line);
  } else if (kind == "scene") {
    replace(
        "targets",
        [](std::size_t /*number*/, const EngineJson& target) {
          return target["id"].get<std::string>();
        },
        [](const EngineJson& target) {
          return target["path"].get<std::string>() +
                 (target["drag"].get<bool>() ? ", can be dragged" : "");
        });
    replace(
        "actions",
        [](std::size_t number, const EngineJson& action) {
          return std::to_string(number) +
                 (action["id"].is_null() ? "" : " " + action["id"].get<std::string>());
        },
        action_line);
  }
  return inspected;
}

}  // namespace marey::app
