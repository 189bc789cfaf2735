// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/split_mix.h"

namespace marey {
namespace {

/// FNV-1a.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001B3U;
  }
  return hash;
}

std::vector<double> spread_statures(const SceneGroup& group, std::uint64_t seed) {
  const auto count = static_cast<std::size_t>(group.count);
  const auto [low, high] = group.statures_m;
  std::vector<double> statures(count, low);
  for (std::size_t k = 1; k < count; ++k) {
    statures[k] =
        low + (high - low) * static_cast<double>(k) / static_cast<double>(count - 1);
  }
  SplitMix random(seed);
  for (std::size_t i = count; i-- > 1;) {
    std::swap(statures[i], statures[static_cast<std::size_t>(random.below(i + 1))]);
  }
  return statures;
}

void vary_build(SceneBuild& build, const SceneGroup& group, std::uint64_t seed) {
  SplitMix random(seed);
  for (double* const ratio :
       {&build.arm, &build.leg, &build.trunk, &build.shoulder_width, &build.hip_width}) {
    *ratio *= 1.0 + group.build_spread * (2.0 * random.unit() - 1.0);
  }
}

glm::dvec2 place_in_grid(const SceneGroup& group, int k) {
  const int rows = (group.count + group.columns - 1) / group.columns;
  const int column = k % group.columns;
  const int row = k / group.columns;
  const double left_m =
      group.spacing_m[0] * (column - 0.5 * (std::min(group.columns, group.count) - 1));
  const double back_m = group.spacing_m[1] * (row - 0.5 * (rows - 1));
  const double sine = std::sin(group.member.heading_rad);
  const double cosine = std::cos(group.member.heading_rad);
  return group.member.place_xz_m + left_m * glm::dvec2(cosine, -sine) -
         back_m * glm::dvec2(sine, cosine);
}

void append_members(const SceneGroup& group,
                    std::uint64_t seed,
                    std::vector<SceneBody>& out) {
  const std::uint64_t own_seed = seed ^ hash_of(group.member.id);
  const std::vector<double> statures_m = spread_statures(group, own_seed);
  for (int k = 0; k < group.count; ++k) {
    SceneBody body = group.member;
    body.id += "." + std::to_string(k + 1);
    body.place_xz_m = place_in_grid(group, k);
    if (auto* const build = std::get_if<SceneBuild>(&body.source)) {
      build->stature_m = statures_m[static_cast<std::size_t>(k)];
      if (group.alternates_sex) {
        build->sex = k % 2 == 0 ? SceneSex::kFemale : SceneSex::kMale;
      }
      vary_build(*build, group, own_seed + static_cast<std::uint64_t>(k) + 1);
    }
    out.push_back(std::move(body));
  }
}

/// Returns the member's position from 0 if `name` is "ID.NUMBER" of the group.
std::optional<std::size_t> member_number(const SceneGroup& group, std::string_view name) {
  const std::string& id = group.member.id;
  if (name.size() < id.size() + 2 || !name.starts_with(id) || name[id.size()] != '.') {
    return std::nullopt;
  }
  const std::string_view digits = name.substr(id.size() + 1);
  int number = 0;
  const auto [end, problem] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool is_number = problem == std::errc{} && end == digits.data() + digits.size();
  if (!is_number || digits.front() == '0' || number < 1 || number > group.count) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(number - 1);
}

}  // namespace

const SceneTarget* Scene::target(std::string_view id) const {
  const auto found = std::find_if(
      targets.begin(), targets.end(), [&](const auto& one) { return one.id == id; });
  return found == targets.end() ? nullptr : &*found;
}

const SceneAction* Scene::action(std::string_view id) const {
  if (id.empty()) return nullptr;
  const auto found = std::find_if(
      script.begin(), script.end(), [&](const auto& one) { return one.id == id; });
  return found == script.end() ? nullptr : &*found;
}

std::vector<SceneBody> scene_bodies(const Scene& scene) {
  std::vector<SceneBody> bodies = scene.bodies;
  bodies.reserve(body_count(scene));
  for (const SceneGroup& group : scene.groups) append_members(group, scene.seed, bodies);
  return bodies;
}

std::size_t body_count(const Scene& scene) {
  std::size_t count = scene.bodies.size();
  for (const SceneGroup& group : scene.groups) {
    count += static_cast<std::size_t>(group.count);
  }
  return count;
}

std::optional<SceneMembers> members_of(const Scene& scene, std::string_view name) {
  std::size_t first = 0;
  for (const SceneBody& body : scene.bodies) {
    if (body.id == name) return SceneMembers{first, 1};
    ++first;
  }
  for (const SceneGroup& group : scene.groups) {
    const auto count = static_cast<std::size_t>(group.count);
    if (group.member.id == name) return SceneMembers{first, count};
    if (const auto number = member_number(group, name)) {
      return SceneMembers{first + *number, 1};
    }
    first += count;
  }
  return std::nullopt;
}

}  // namespace marey
