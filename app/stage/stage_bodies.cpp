// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/stage_bodies.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>
#include <variant>

#include "app/adapt/load_character.h"
#include "app/motion/retarget_files.h"
#include "app/stage/body_point.h"
#include "core/pose.h"
#include "recordings/body/mannequin.h"
#include "retarget/character/make_character.h"

namespace marey::app {
namespace {

constexpr std::array<const char*, 2> kHands{"leftHand", "rightHand"};
constexpr double kBodyMassIndex_kg_m2 = 22.0;

MassTable table_of(SceneSex sex) {
  if (sex == SceneSex::kFemale) return MassTable::kDeLevaFemale;
  return sex == SceneSex::kMale ? MassTable::kDeLevaMale : MassTable::kDeLeva;
}

Result<Character> mannequin_of(const std::string& id, const SceneBuild& build) {
  Skeleton skeleton = make_humanoid(
      recordings::mannequin_proportions({.stature_m = build.stature_m,
                                         .arm = build.arm,
                                         .leg = build.leg,
                                         .foot = build.foot,
                                         .trunk = build.trunk,
                                         .head = build.head,
                                         .shoulder_width = build.shoulder_width,
                                         .hip_width = build.hip_width}));
  const auto map = retarget::map_body(skeleton);
  if (!map) return map.error();
  CharacterTraits traits;
  traits.mass.table = table_of(build.sex);
  traits.mass.total_kg =
      build.mass_kg.value_or(kBodyMassIndex_kg_m2 * build.stature_m * build.stature_m);
  return retarget::make_character(id, std::move(skeleton), *map, traits);
}

Result<Character> character_of_file(const std::string& id, const std::string& path) {
  if (std::filesystem::path(path).extension() == ".toml") return load_character(path);
  auto skeleton = read_skeleton(std::filesystem::path(path));
  if (!skeleton) return skeleton.error();
  const auto map = retarget::map_body(*skeleton);
  if (!map) return map.error();
  return retarget::make_character(id, *std::move(skeleton), *map);
}

/// Returns the height of the rest pose above its soles, with the tip of the head.
double stature_of(const Skeleton& skeleton) {
  const Pose rest = rest_pose(skeleton);
  double top_m = 0.0;
  double low_m = 0.0;
  const auto joints = world_from_joints(skeleton, rest);
  for (const RigidTransform& joint : joints) {
    top_m = std::max(top_m, joint.translation.y);
    low_m = std::min(low_m, joint.translation.y);
  }
  return top_m - low_m;
}

Status add_load(StageBody& body, std::string name, const BodyPoint& point, double kg) {
  const auto place = point_of_body(body.character.skeleton, body.map, point);
  if (!place) {
    return bad_input("body \"" + body.id + "\"",
                     "it has no " + point.segment + " to carry a load with",
                     "use a body with hands");
  }
  Load load;
  load.name = std::move(name);
  load.mass.joint = place->joint;
  load.mass.p_in_joint = place->offset_in_joint;
  load.mass.mass_kg = kg;
  body.character.loads.push_back(std::move(load));
  return Done{};
}

Status add_loads(StageBody& body,
                 const SceneBody& wanted,
                 const Scene& scene,
                 std::size_t position) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (wanted.hand_loads_kg[side] <= 0.0) continue;
    if (const Status ok = add_load(
            body, hand_load_name(side), {kHands[side], {}}, wanted.hand_loads_kg[side]);
        !ok) {
      return ok;
    }
  }
  for (std::size_t i = 0; i < scene.script.size(); ++i) {
    const auto* carry = std::get_if<SceneCarry>(&scene.script[i].deed);
    const auto members = members_of(scene, scene.script[i].body);
    if (carry == nullptr || !members || position < members->first ||
        position >= members->first + members->count) {
      continue;
    }
    const BodyPoint point{kHands[static_cast<std::size_t>(carry->hand)],
                          carry->offset_in_t_pose};
    if (const Status ok = add_load(body, carry_load_name(i), point, carry->mass_kg);
        !ok) {
      return ok;
    }
  }
  return Done{};
}

Error of_body(Error error, const std::string& id) {
  error.where = "body \"" + id + "\": " + error.where;
  return error;
}

Result<StageBody> load_stage_body(const SceneBody& wanted) {
  const auto* build = std::get_if<SceneBuild>(&wanted.source);
  auto character =
      build != nullptr
          ? mannequin_of(wanted.id, *build)
          : character_of_file(wanted.id, std::get<SceneBodyFile>(wanted.source).path);
  if (!character) return of_body(character.error(), wanted.id);
  StageBody body;
  body.id = wanted.id;
  body.character = *std::move(character);
  body.character.name = wanted.id;
  auto map = retarget::map_body(body.character.skeleton);
  if (!map) return of_body(map.error(), wanted.id);
  body.map = *std::move(map);
  body.start = {wanted.place_xz_m.x, wanted.place_xz_m.y, wanted.heading_rad};
  body.stature_m =
      build != nullptr ? build->stature_m : stature_of(body.character.skeleton);
  return body;
}

}  // namespace

std::string hand_load_name(std::size_t side) {
  return side == 0 ? "load of the left hand" : "load of the right hand";
}

std::string carry_load_name(std::size_t action) {
  return "load of action " + std::to_string(action + 1);
}

Result<std::vector<StageBody>> load_stage_bodies(const Scene& scene) {
  std::vector<StageBody> out;
  for (const SceneBody& wanted : scene_bodies(scene)) {
    auto body = load_stage_body(wanted);
    if (!body) return body.error();
    if (const Status ok = add_loads(*body, wanted, scene, out.size()); !ok) {
      return ok.error();
    }
    out.push_back(*std::move(body));
  }
  return out;
}

}  // namespace marey::app
