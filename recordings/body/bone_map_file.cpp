// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/bone_map_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings {
namespace {

constexpr Limits kUnit{1e-6, 1e3, "m"};

/// Number of joints with this name, and the first of them.
struct Bearers {
  std::size_t count = 0;
  JointIndex first{};
};

std::map<std::string_view, Bearers> bearers_of(const Skeleton& skeleton) {
  std::map<std::string_view, Bearers> names;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    Bearers& bearers = names[skeleton.joints[i].name];
    if (bearers.count++ == 0) bearers.first = JointIndex{static_cast<int>(i)};
  }
  return names;
}

/// Reads "+Z" or three numbers.
std::optional<glm::dvec3> read_direction(TomlReader& in, std::string_view key) {
  if (!in.has(key)) return std::nullopt;
  glm::dvec3 direction(0.0);
  if (in.count(key) > 0) {
    const std::vector<double> numbers = in.numbers(key, 3);
    if (!in.ok()) return std::nullopt;
    direction = {numbers[0], numbers[1], numbers[2]};
  } else {
    const std::string word = in.text(key);
    if (!in.ok()) return std::nullopt;
    const bool is_axis = word.size() == 2 && (word[0] == '+' || word[0] == '-') &&
                         word[1] >= 'X' && word[1] <= 'Z';
    if (is_axis) direction[word[1] - 'X'] = word[0] == '+' ? 1.0 : -1.0;
  }
  const double length = glm::length(direction);
  if (length > 1e-6 && length < 1e6) return direction / length;
  in.fail(key,
          in_quotes(key) + " is not a direction",
          "give one of +X, +Y, +Z, -X, -Y, -Z, or three numbers");
  return std::nullopt;
}

void read_bone(TomlReader& in,
               const std::string& key,
               const std::map<std::string_view, Bearers>& names,
               BoneMap& map) {
  const auto bone = human_bone(key);
  if (!bone) {
    in.fail(key, "there is no bone " + in_quotes(key), bone_suggestion(key));
    return;
  }
  const std::string joint = in.text(key);
  if (!in.ok()) return;
  BoneOverride& bone_override = map.bones[index(*bone)];
  bone_override.is_set = true;
  if (joint.empty()) return;
  const auto found = names.find(joint);
  if (found == names.end()) {
    std::vector<std::string_view> words;
    for (const auto& [name, bearers] : names) words.push_back(name);
    // Not all names: there may be hundreds.
    const auto nearest = nearest_words(joint, words, 5);
    in.fail(key, "the body has no joint " + in_quotes(joint), suggestion(joint, nearest));
    return;
  }
  if (found->second.count > 1) {
    in.fail(key,
            "the body has " + std::to_string(found->second.count) + " joints " +
                in_quotes(joint),
            "give them names of their own");
    return;
  }
  bone_override.joint = found->second.first;
  for (const HumanBone other : human_bones()) {
    if (other == *bone || map.bones[index(other)].joint != bone_override.joint) continue;
    in.fail(key,
            in_quotes(joint) + " is " + std::string(name(other)) + " already",
            "name another joint, or \"\" for a bone that the body does not have");
  }
}

std::string direction_word(const glm::dvec3& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1.0 - 1e-9) continue;
    return {direction[axis] > 0.0 ? '+' : '-', static_cast<char>('X' + axis)};
  }
  return {};
}

void write_direction(TomlWriter& out,
                     std::string_view key,
                     const std::optional<glm::dvec3>& direction) {
  if (!direction) return;
  const std::string word = direction_word(*direction);
  if (word.empty()) {
    out.numbers(key, {direction->x, direction->y, direction->z});
  } else {
    out.text(key, word);
  }
}

}  // namespace

std::filesystem::path bone_map_path(const std::filesystem::path& body) {
  return std::filesystem::path(body).replace_extension(".bones.toml");
}

std::string bone_map_text(const BoneMap& map, const Skeleton& skeleton) {
  const auto names = bearers_of(skeleton);
  TomlWriter out;
  out.comment("Which joint is which bone; \"\" where the body has none.");
  if (map.unit_m) out.number("unit_m", *map.unit_m);
  write_direction(out, "up", map.up);
  write_direction(out, "front", map.front);
  out.table({"bones"});
  for (const HumanBone bone : human_bones()) {
    const BoneOverride& bone_override = map.bones[index(bone)];
    if (!bone_override.is_set) continue;
    if (!bone_override.joint) {
      out.text(name(bone), "");
      continue;
    }
    const std::string& joint = skeleton[*bone_override.joint].name;
    if (joint.empty() || names.at(joint).count > 1) continue;
    out.text(name(bone), joint);
  }
  return out.str();
}

Status write_bone_map(const std::filesystem::path& path,
                      const BoneMap& map,
                      const Skeleton& skeleton) {
  return write_file(path, bone_map_text(map, skeleton));
}

Result<BoneMap> parse_bone_map(std::string_view text,
                               const std::string& file,
                               const Skeleton& skeleton) {
  auto document = parse_toml(text, file, "bodies.md");
  if (!document) return document.error();
  TomlReader in(*document);
  in.allow({"unit_m", "up", "front", "bones"});
  BoneMap map;
  if (in.has("unit_m")) map.unit_m = in.number("unit_m", kUnit);
  map.up = read_direction(in, "up");
  map.front = read_direction(in, "front");
  if (in.ok() && map.up && map.front && std::abs(glm::dot(*map.up, *map.front)) > 0.5) {
    in.fail("front",
            "\"front\" is not across \"up\"",
            "give two directions that are at right angles");
  }
  if (in.has("bones")) {
    TomlReader bones = in.table("bones");
    const auto names = bearers_of(skeleton);
    for (const std::string& key : bones.keys()) {
      if (in.ok()) read_bone(bones, key, names, map);
    }
  }
  if (document->mistake) return mistake_of(*document, TomlKind::kBoneMap);
  return map;
}

Result<BoneMap> read_bone_map(const std::filesystem::path& path,
                              const Skeleton& skeleton) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_bone_map(*text, path.string(), skeleton);
}

}  // namespace marey::recordings
