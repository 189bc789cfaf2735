// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_scene.h"

#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/read_bodies.h"
#include "recordings/scene/read_results.h"
#include "recordings/scene/read_script.h"
#include "recordings/scene/read_targets.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings {
namespace {

constexpr int kSceneFormat = 1;
constexpr std::string_view kScenePage = "scene.md";

void check_scene_format(TomlReader& root) {
  const int format = root.integer("format", {0, 1e6});
  if (!root.ok() || format == kSceneFormat) return;
  std::string cause = "its format is ";
  append_exact(cause, format);
  const bool is_newer = format > kSceneFormat;
  if (is_newer) {
    cause = "the scene was made for a newer marey: " + cause + ", and this marey reads 1";
  }
  root.fail("format", std::move(cause), is_newer ? "update marey" : "write format = 1");
}

/// Reads the name, which becomes a part of file names.
std::string read_scene_name(TomlReader& in) {
  std::string name = recipe::read_line(in, "name", stage::kMaxIdBytes);
  if (name.find_first_of("/\\") != std::string::npos || name.starts_with('.')) {
    in.fail("name",
            in_quotes(name) + " cannot be a part of a file name",
            "write a name without slashes that does not begin with a dot");
  }
  return name;
}

void read_head(TomlReader& root, Scene& scene) {
  scene.name = read_scene_name(root);
  if (root.has("seed")) {
    scene.seed = static_cast<std::uint64_t>(root.integer("seed", stage::kSeed));
  }
  stage::read_number(root, "step_hz", scene.step_hz, stage::kStepRate);
  scene.duration_s = root.number("duration_s", stage::kSceneDuration);
  scene.base = recipe::read_line(root, "base", stage::kMaxPathBytes);
  stage::read_text(root, "floor", scene.floor, stage::kMaxPathBytes);
  stage::read_number(root, "gravity_m_s2", scene.gravity_m_s2, stage::kGravity);
  stage::read_number(root, "budget_units", scene.budget_units, stage::kUnits);
  if (!root.has("cost_units")) return;
  const std::vector<double> costs =
      recipe::read_numbers(root, "cost_units", 4, stage::kCost);
  for (std::size_t level = 1; level < costs.size(); ++level) {
    if (costs[level] > costs[level - 1]) continue;
    root.fail("cost_units",
              "\"cost_units\" does not ascend",
              "give the costs of the levels 0, 1, 2 and 3");
  }
  scene.cost_units = std::array{costs[0], costs[1], costs[2], costs[3]};
}

void resolve(std::string& path, const std::filesystem::path& folder) {
  if (!path.empty()) path = (folder / path).lexically_normal().string();
}

void resolve_body(SceneBody& body, const std::filesystem::path& folder) {
  if (auto* const file = std::get_if<SceneBodyFile>(&body.source)) {
    resolve(file->path, folder);
  }
  resolve(body.constraints, folder);
}

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& file) {
  if (text.size() > stage::kMaxSceneBytes) {
    return bad_input(file, "the scene is larger than 4 MiB", "divide the scene");
  }
  Result<TomlDocument> document = parse_toml(text, file, kScenePage);
  if (!document) return document.error();
  TomlReader root(*document);
  Scene scene;
  check_scene_format(root);
  root.allow({"format",
              "name",
              "seed",
              "step_hz",
              "duration_s",
              "base",
              "floor",
              "gravity_m_s2",
              "budget_units",
              "cost_units",
              "body",
              "group",
              "target",
              "at",
              "out",
              "measure"});
  if (root.ok()) read_head(root, scene);
  if (root.ok()) stage::read_bodies(root, scene);
  if (root.ok()) stage::read_targets(root, scene);
  if (root.ok()) stage::read_script(root, scene);
  if (root.ok()) stage::read_results(root, scene);
  if (document->mistake) return mistake_of(*document, TomlKind::kScene);
  return scene;
}

Result<Scene> read_scene(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  Result<Scene> scene = parse_scene(*text, path.string());
  if (!scene) return scene;
  const std::filesystem::path folder = path.parent_path();
  resolve(scene->base, folder);
  resolve(scene->floor, folder);
  for (SceneBody& body : scene->bodies) resolve_body(body, folder);
  for (SceneGroup& group : scene->groups) resolve_body(group.member, folder);
  for (SceneAction& action : scene->script) {
    if (auto* const deed = std::get_if<SceneThrow>(&action.deed)) {
      resolve(deed->trials, folder);
    }
  }
  return scene;
}

}  // namespace marey::recordings
