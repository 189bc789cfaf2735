// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_bodies.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/in_quotes.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings::stage {
namespace {

using Keys = std::vector<std::string_view>;

constexpr std::array<std::string_view, 3> kSexWords{"mean", "female", "male"};
constexpr std::string_view kAlternate = "alternate";

/// Keys of every body; "stature_m" to "girth" are those of a mannequin.
const Keys& shared_body_keys() {
  static const Keys kKeys{"id",         "file",           "stature_m",
                          "sex",        "mass_kg",        "arm",
                          "leg",        "foot",           "trunk",
                          "head",       "shoulder_width", "hip_width",
                          "girth",      "place_m",        "heading_deg",
                          "importance", "level",          "hand_loads_kg",
                          "idle",       "constraints"};
  return kKeys;
}

void read_ratios(TomlReader& in, SceneBuild& build) {
  read_number(in, "mass_kg", build.mass_kg, kMass);
  read_number(in, "arm", build.arm, kRatio);
  read_number(in, "leg", build.leg, kRatio);
  read_number(in, "foot", build.foot, kRatio);
  read_number(in, "trunk", build.trunk, kRatio);
  read_number(in, "head", build.head, kRatio);
  read_number(in, "shoulder_width", build.shoulder_width, kRatio);
  read_number(in, "hip_width", build.hip_width, kRatio);
  read_number(in, "girth", build.girth, kRatio);
}

void read_file_body(TomlReader& in, SceneBody& body) {
  for (const std::string_view key : {"stature_m",
                                     "sex",
                                     "mass_kg",
                                     "arm",
                                     "leg",
                                     "foot",
                                     "trunk",
                                     "head",
                                     "shoulder_width",
                                     "hip_width",
                                     "girth",
                                     "build_spread"}) {
    if (!in.has(key)) continue;
    in.fail(key,
            "both \"file\" and " + in_quotes(key) + " are given",
            "remove one: the file has the body's proportions and masses");
  }
  body.source = SceneBodyFile{recipe::read_line(in, "file", kMaxPathBytes)};
}

/// Reads the keys that bodies and groups have in common, except stature and sex.
void read_shared(TomlReader& in, SceneBody& body) {
  body.line = in.line();
  if (in.has("place_m")) {
    const std::vector<double> place = recipe::read_numbers(in, "place_m", 2, kPlace);
    body.place_xz_m = {place[0], place[1]};
  }
  read_degrees(in, "heading_deg", body.heading_rad, kAngle);
  read_number(in, "importance", body.importance, kImportance);
  read_integer(in, "level", body.level, kLevel);
  if (in.has("hand_loads_kg")) {
    const std::vector<double> loads = recipe::read_numbers(in, "hand_loads_kg", 2, kLoad);
    body.hand_loads_kg = {loads[0], loads[1]};
  }
  read_text(in, "idle", body.idle, kMaxNameBytes);
  read_text(in, "constraints", body.constraints, kMaxPathBytes);
}

/// Ids of bodies and groups so far.
class TakenIds {
 public:
  explicit TakenIds(Scene& scene) : scene_(scene) {}

  std::string read(TomlReader& in) {
    std::string id = read_id(in, "id", ids_);
    if (in.ok() && members_of(scene_, id)) {
      in.fail("id",
              in_quotes(id) + " is a member of a group",
              "choose another id: members are named GROUP.NUMBER");
    }
    ids_.push_back(id);
    return id;
  }

 private:
  Scene& scene_;
  std::vector<std::string> ids_;
};

SceneBody read_body(TomlReader& in, TakenIds& ids) {
  in.allow(shared_body_keys());
  SceneBody body;
  body.id = ids.read(in);
  read_shared(in, body);
  if (in.has("file")) {
    read_file_body(in, body);
    return body;
  }
  SceneBuild build;
  read_number(in, "stature_m", build.stature_m, kStature);
  read_word(in, "sex", build.sex, kSexWords);
  read_ratios(in, build);
  body.source = build;
  return body;
}

void read_group_build(TomlReader& in, SceneGroup& group) {
  SceneBuild build;
  read_range(in, "stature_m", group.statures_m, kStature);
  build.stature_m = group.statures_m[0];
  if (in.has("sex")) {
    constexpr std::array<std::string_view, 4> kWords{
        kSexWords[0], kSexWords[1], kSexWords[2], kAlternate};
    const std::size_t word = read_choice_of(in, "sex", kWords);
    group.alternates_sex = word == kSexWords.size();
    if (!group.alternates_sex) build.sex = static_cast<SceneSex>(word);
  }
  read_ratios(in, build);
  read_number(in, "build_spread", group.build_spread, kSpread);
  group.member.source = build;
}

SceneGroup read_group(TomlReader& in, TakenIds& ids, const Scene& scene) {
  Keys keys = shared_body_keys();
  for (const std::string_view key : {"count", "build_spread", "columns", "spacing_m"}) {
    keys.push_back(key);
  }
  in.allow(keys);
  SceneGroup group;
  group.member.id = ids.read(in);
  group.count = in.integer("count", kMembers);
  group.columns = in.has("columns") ? in.integer("columns", kMembers) : group.count;
  if (in.has("spacing_m")) {
    const std::vector<double> gaps = recipe::read_numbers(in, "spacing_m", 2, kPlace);
    group.spacing_m = {gaps[0], gaps[1]};
  }
  read_shared(in, group.member);
  if (in.has("file")) {
    read_file_body(in, group.member);
  } else {
    read_group_build(in, group);
  }
  Scene alone;
  alone.groups.push_back(group);
  for (const std::string& id : body_names(scene)) {
    if (!in.ok()) break;
    if (id == group.member.id || !members_of(alone, id)) continue;
    in.fail("id",
            in_quotes(id) + " has the id of a member of this group",
            "choose another id: members are named GROUP.NUMBER");
  }
  return group;
}

}  // namespace

void read_bodies(TomlReader& root, Scene& scene) {
  check_count(root, "body", kMaxBodies);
  check_count(root, "group", kMaxTables);
  TakenIds ids(scene);
  for (TomlReader& table : root.tables("body")) {
    SceneBody body = read_body(table, ids);
    if (!root.ok()) return;
    scene.bodies.push_back(std::move(body));
  }
  for (TomlReader& table : root.tables("group")) {
    SceneGroup group = read_group(table, ids, scene);
    if (!root.ok()) return;
    scene.groups.push_back(std::move(group));
  }
  if (body_count(scene) == 0) {
    root.fail("", "the scene has no body", "add [[body]] with an id, or [[group]]");
  }
  if (body_count(scene) > kMaxBodies) {
    root.fail("group",
              "the scene has more than 5000 bodies",
              "reduce the counts of the groups");
  }
}

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const SceneBody& body : scene.bodies) names.push_back(body.id);
  for (const SceneGroup& group : scene.groups) names.push_back(group.member.id);
  return names;
}

SceneMembers read_members(TomlReader& in,
                          std::string_view key,
                          const Scene& scene,
                          std::string& name) {
  name = recipe::read_line(in, key, kMaxIdBytes);
  if (!in.ok()) return {};
  if (const auto members = members_of(scene, name)) return *members;
  fail_unknown(in, key, "body or group", name, body_names(scene));
  return {};
}

}  // namespace marey::recordings::stage
