// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/stage_bodies.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include "app/adapt/load_character.h"
#include "app/motion/error_of_file.h"
#include "app/motion/read_body.h"
#include "core/base/extension.h"
#include "core/character_spec.h"
#include "core/human/average_proportions.h"
#include "recordings/body/constraints_file.h"
#include "recordings/body/mannequin.h"
#include "retarget/character/make_character.h"

namespace marey::app {
namespace {

struct CastBody {
  Character character;
  retarget::BodyMap map;
  std::optional<recordings::SkinnedMesh> mesh{};
};

recordings::MannequinOptions mannequin_of(const SceneBuild& build) {
  recordings::MannequinOptions out;
  out.stature_m = build.stature_m;
  out.arm = build.arm;
  out.leg = build.leg;
  out.foot = build.foot;
  out.trunk = build.trunk;
  out.head = build.head;
  out.shoulder_width = build.shoulder_width;
  out.hip_width = build.hip_width;
  return out;
}

MassTable mass_table(SceneSex sex) {
  switch (sex) {
    case SceneSex::kFemale:
      return MassTable::kDeLevaFemale;
    case SceneSex::kMale:
      return MassTable::kDeLevaMale;
    case SceneSex::kMean:
      break;
  }
  return MassTable::kDeLeva;
}

Result<CastBody> make_mannequin(const SceneBody& line, const SceneBuild& build) {
  constexpr double kBodyMassIndex = 22.0;  // kg/m^2
  const Proportions proportions = recordings::mannequin_proportions(mannequin_of(build));
  CastBody out;
  Skeleton skeleton = make_humanoid(proportions);
  auto map = retarget::map_body(skeleton);
  if (!map) return map.error();
  out.map = *std::move(map);
  CharacterTraits traits;
  traits.mass.table = mass_table(build.sex);
  traits.mass.total_kg =
      build.mass_kg.value_or(kBodyMassIndex * build.stature_m * build.stature_m);
  auto character =
      retarget::make_character(line.id, std::move(skeleton), out.map, traits);
  if (!character) return character.error();
  out.character = *std::move(character);
  recordings::MannequinStyle style;
  style.girth = build.girth;
  out.mesh = recordings::make_mannequin_mesh(proportions, style);
  return out;
}

// The mesh of a file in marey's frame; nullopt: none, or its joints were changed.
std::optional<recordings::SkinnedMesh> mesh_of(ReadBody& body) {
  if (!body.raw.mesh || !body.read_joint.empty() || body.rests_as_bound) {
    return std::nullopt;
  }
  recordings::SkinnedMesh mesh = *std::move(body.raw.mesh);
  for (glm::dvec3& p : mesh.p_in_world) {
    p = body.frame.scale * (body.frame.marey_from_file * p);
  }
  for (glm::dvec3& n : mesh.normal_in_world) n = body.frame.marey_from_file * n;
  return mesh;
}

Result<CastBody> read_cast_body(const std::string& file) {
  CastBody out;
  if (kind_by_extension(file) == ".toml") {
    auto character = load_character(file);
    if (!character) return character.error();
    out.character = *std::move(character);
  } else {
    auto body = read_body(std::filesystem::path(file));
    if (!body) return body.error();
    const auto map = retarget::map_body(body->skeleton());
    if (!map) return of_file(file, map.error());
    auto character = retarget::make_character(
        std::filesystem::path(file).stem().string(), body->skeleton(), *map, {});
    if (!character) return of_file(file, character.error());
    out.character = *std::move(character);
    out.mesh = mesh_of(*body);
  }
  auto map = retarget::map_body(out.character.skeleton);
  if (!map) return of_file(file, map.error());
  out.map = *std::move(map);
  return out;
}

// Stature of a body with average proportions and these legs.
double stature_of(const SceneBody& line, const retarget::BodyMap& map) {
  if (const auto* build = std::get_if<SceneBuild>(&line.source)) return build->stature_m;
  const Skeleton average = make_humanoid(average_proportions(1.0));
  const auto average_map = retarget::map_body(average);
  return map.leg_length_m / average_map->leg_length_m;
}

void add_hand_loads(const SceneBody& line, StageBody& body) {
  constexpr std::array kHands{HumanBone::kLeftHand, HumanBone::kRightHand};
  constexpr std::array kNames{"left hand", "right hand"};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto joint = body.map.joint_of[index(kHands[side])];
    if (line.hand_loads_kg[side] <= 0.0 || !joint) continue;
    body.character.loads.push_back(
        {kNames[side], {*joint, glm::dvec3(0.0), line.hand_loads_kg[side]}});
  }
}

}  // namespace

Result<StageCast> read_stage_cast(const Scene& scene) {
  StageCast out;
  std::map<std::string, CastBody> files;
  for (const SceneBody& line : scene_bodies(scene)) {
    CastBody cast;
    if (const auto* build = std::get_if<SceneBuild>(&line.source)) {
      auto made = make_mannequin(line, *build);
      if (!made) return made.error();
      cast = *std::move(made);
    } else {
      const std::string& path = std::get<SceneBodyFile>(line.source).path;
      if (!files.contains(path)) {
        auto read = read_cast_body(path);
        if (!read) return read.error();
        files[path] = *std::move(read);
      }
      cast = files[path];
    }
    StageBody body;
    body.id = line.id;
    body.start = {line.place_xz_m.x, line.place_xz_m.y, line.heading_rad};
    body.stature_m = stature_of(line, cast.map);
    body.character = std::move(cast.character);
    body.character.name = line.id;
    body.map = std::move(cast.map);
    add_hand_loads(line, body);
    if (!line.constraints.empty()) {
      auto constraints = recordings::read_constraints(line.constraints);
      if (!constraints) return constraints.error();
      body.constraints = std::move(constraints->set);
    }
    out.bodies.push_back(std::move(body));
    out.meshes.push_back(std::move(cast.mesh));
  }
  return out;
}

}  // namespace marey::app
