// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_results.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/read_bodies.h"
#include "recordings/scene/read_targets.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings::stage {
namespace {

constexpr std::size_t kMaxPictures = 1000;

ScenePicture read_picture(TomlReader& in, const Scene& scene) {
  in.allow({"time_s", "camera_m", "looks_at_m", "width_px", "height_px"});
  ScenePicture picture;
  picture.time_s = in.number("time_s", {0.0, scene.duration_s, "s"});
  for (const bool is_camera : {true, false}) {
    const std::vector<double> p =
        recipe::read_numbers(in, is_camera ? "camera_m" : "looks_at_m", 3, kPlace);
    (is_camera ? picture.camera_in_world : picture.looks_at_in_world) = {
        p[0], p[1], p[2]};
  }
  if (in.ok() && picture.camera_in_world == picture.looks_at_in_world) {
    in.fail("looks_at_m",
            "the camera looks at its own place",
            "give two different positions");
  }
  if (in.has("width_px")) picture.width_px = in.integer("width_px", kPixels);
  if (in.has("height_px")) picture.height_px = in.integer("height_px", kPixels);
  return picture;
}

SceneVmc read_vmc(TomlReader& in, const Scene& scene) {
  in.allow({"body", "port"});
  SceneVmc vmc;
  if (read_members(in, "body", scene, vmc.body).count > 1) {
    in.fail("body",
            "one port sends one body, and " + in_quotes(vmc.body) + " is a group",
            "name a member, as \"" + vmc.body + ".1\"");
  }
  vmc.port = in.integer("port", kPort);
  for (const SceneVmc& other : scene.out.vmc) {
    if (other.port != vmc.port) continue;
    in.fail("port", "the port is used twice", "give each body a port of its own");
  }
  return vmc;
}

void read_out(TomlReader in, Scene& scene) {
  in.allow({"glb", "glb_rate_hz", "picture", "vmc"});
  read_boolean(in, "glb", scene.out.glb);
  read_number(in, "glb_rate_hz", scene.out.glb_rate_hz, kPictureRate);
  check_count(in, "picture", kMaxPictures);
  for (TomlReader& table : in.tables("picture")) {
    scene.out.pictures.push_back(read_picture(table, scene));
    if (!in.ok()) return;
  }
  check_count(in, "vmc", kMaxPictures);
  for (TomlReader& table : in.tables("vmc")) {
    scene.out.vmc.push_back(read_vmc(table, scene));
    if (!in.ok()) return;
  }
}

/// Reads the bodies of a figure: one name, or a list of them.
void read_figure_bodies(TomlReader& in, const Scene& scene, SceneFigure& figure) {
  if (in.has("body")) {
    std::string name;
    (void)read_members(in, "body", scene, name);
    figure.bodies.push_back(std::move(name));
    if (in.has("bodies")) recipe::fail_twice(in, "body", "bodies");
    return;
  }
  if (!in.has("bodies")) {
    in.fail("", "the key \"body\" is missing in [[measure]]", "add body, or bodies");
    return;
  }
  figure.bodies = in.texts("bodies");
  if (figure.bodies.empty()) {
    in.fail("bodies", "\"bodies\" is empty", "name one body or more");
  }
  for (const std::string& name : figure.bodies) {
    if (!in.ok() || members_of(scene, name)) continue;
    fail_unknown(in, "bodies", "body or group", name, body_names(scene));
  }
}

std::string read_action_id(TomlReader& in, const Scene& scene) {
  std::string id = recipe::read_line(in, "action", kMaxIdBytes);
  if (!in.ok() || scene.action(id) != nullptr) return id;
  std::vector<std::string> ids;
  for (const SceneAction& action : scene.script) {
    if (!action.id.empty()) ids.push_back(action.id);
  }
  fail_unknown(in, "action", "action", id, ids);
  return id;
}

/// Returns "max_mm" for "max"; the word alone for a ratio.
std::string with_unit(std::string_view word, const SceneFigureRule& rule) {
  std::string key(word);
  if (!rule.unit.empty()) key.append("_").append(rule.unit);
  return key;
}

void allow_figure(TomlReader& in, const SceneFigureRule& rule) {
  const std::string max = with_unit("max", rule);
  const std::string min = with_unit("min", rule);
  std::vector<std::string_view> keys{"kind", max, min, "from_s", "to_s"};
  const auto add = [&](bool needed, std::initializer_list<std::string_view> more) {
    if (needed) keys.insert(keys.end(), more);
  };
  add(rule.needs_body, {"body", "bodies", "ascending"});
  add(rule.needs_point, {"segment", "offset_m"});
  add(rule.needs_target, {"target"});
  add(rule.needs_action, {"action"});
  add(rule.needs_event, {"event"});
  add(rule.needs_clip, {"clip"});
  in.allow(keys);
}

void read_bounds(TomlReader& in, const SceneFigureRule& rule, SceneFigure& figure) {
  const std::string max = with_unit("max", rule);
  const std::string min = with_unit("min", rule);
  read_number(in, max, figure.max, kValue);
  read_number(in, min, figure.min, kValue);
  if (figure.min && figure.max && *figure.min > *figure.max) {
    in.fail(min, in_quotes(min) + " is above " + in_quotes(max), "exchange them");
  }
  read_number(in, "from_s", figure.from_s, kTime);
  read_number(in, "to_s", figure.to_s, kTime);
  if (figure.to_s && *figure.to_s <= figure.from_s) {
    in.fail("to_s", "the figure ends before it starts", "give a later to_s");
  }
}

SceneFigure read_figure(TomlReader& in, const Scene& scene) {
  SceneFigure figure;
  figure.line = in.line();
  std::vector<std::string_view> words;
  for (const SceneFigureRule& rule : kSceneFigureRules) words.push_back(rule.word);
  const std::size_t kind = read_choice_of(in, "kind", words);
  if (!in.ok()) return figure;
  const SceneFigureRule& rule = kSceneFigureRules[kind];
  figure.kind = rule.kind;
  allow_figure(in, rule);
  if (rule.needs_body) read_figure_bodies(in, scene, figure);
  if (rule.needs_point) figure.point = read_point(in);
  if (rule.needs_target) figure.target = read_target_id(in, "target", scene);
  if (rule.needs_action) figure.action = read_action_id(in, scene);
  if (rule.needs_event) figure.event = recipe::read_line(in, "event", kMaxNameBytes);
  const std::string_view users = in.has("body") ? "body" : "bodies";
  for (const std::string& body : figure.bodies) {
    if (!figure.target.empty()) {
      check_target_pairs(in, users, scene, body, figure.target);
    }
    const SceneAction* const action = scene.action(figure.action);
    if (!rule.needs_event || action == nullptr) continue;
    check_pairs(
        in, users, scene, body, action->body, "the action " + in_quotes(figure.action));
  }
  if (rule.needs_clip) figure.clip = recipe::read_line(in, "clip", kMaxNameBytes);
  read_boolean(in, "ascending", figure.ascending);
  read_bounds(in, rule, figure);
  return figure;
}

}  // namespace

void read_results(TomlReader& root, Scene& scene) {
  if (root.has("out")) read_out(root.table("out"), scene);
  check_count(root, "measure", kMaxTables);
  for (TomlReader& table : root.tables("measure")) {
    SceneFigure figure = read_figure(table, scene);
    if (!root.ok()) return;
    scene.figures.push_back(std::move(figure));
  }
}

}  // namespace marey::recordings::stage
