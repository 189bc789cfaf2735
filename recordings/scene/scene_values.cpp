// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/scene_values.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/base/degrees.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/number_text.h"
#include "recordings/edit/edit_key_reader.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/scene_limits.h"

namespace marey::recordings::stage {
namespace {

constexpr std::array<std::string_view, 2> kHandWords{"left", "right"};

bool is_id_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         c == '_' || c == '-' || c == '.';
}

}  // namespace

void read_number(TomlReader& in,
                 std::string_view key,
                 double& out,
                 const Limits& limits) {
  if (in.has(key)) out = in.number(key, limits);
}

void read_number(TomlReader& in,
                 std::string_view key,
                 std::optional<double>& out,
                 const Limits& limits) {
  if (in.has(key)) out = in.number(key, limits);
}

void read_degrees(TomlReader& in,
                  std::string_view key,
                  double& out_rad,
                  const Limits& limits) {
  if (in.has(key)) out_rad = in.number(key, limits) * kRadiansPerDegree;
}

void read_degrees(TomlReader& in,
                  std::string_view key,
                  std::optional<double>& out_rad,
                  const Limits& limits) {
  if (in.has(key)) out_rad = in.number(key, limits) * kRadiansPerDegree;
}

void read_integer(TomlReader& in,
                  std::string_view key,
                  std::optional<int>& out,
                  const Limits& limits) {
  if (in.has(key)) out = in.integer(key, limits);
}

void read_boolean(TomlReader& in, std::string_view key, bool& out) {
  if (in.has(key)) out = in.boolean(key);
}

void read_text(TomlReader& in,
               std::string_view key,
               std::string& out,
               std::size_t max_bytes) {
  if (in.has(key)) out = recipe::read_line(in, key, max_bytes);
}

void read_vector(TomlReader& in,
                 std::string_view key,
                 glm::dvec3& out,
                 const Limits& limits) {
  if (!in.has(key)) return;
  const std::vector<double> v = recipe::read_numbers(in, key, 3, limits);
  out = {v[0], v[1], v[2]};
}

void read_range(TomlReader& in,
                std::string_view key,
                std::array<double, 2>& out,
                const Limits& limits) {
  if (!in.has(key)) return;
  const std::vector<double> ends = recipe::read_numbers(in, key, 2, limits);
  if (ends[0] > ends[1]) {
    in.fail(key, in_quotes(key) + " descends", "give the smaller number first");
  }
  out = {ends[0], ends[1]};
}

void read_hand(TomlReader& in, std::string_view key, SceneHand& out) {
  read_word(in, key, out, kHandWords);
}

BodyPoint read_point(TomlReader& in) {
  BodyPoint point{recipe::read_line(in, "segment", kMaxNameBytes), glm::dvec3(0.0)};
  read_vector(in, "offset_m", point.offset_in_t_pose, kOffset);
  return point;
}

std::string read_id(TomlReader& in,
                    std::string_view key,
                    std::span<const std::string> taken) {
  std::string id = recipe::read_line(in, key, kMaxIdBytes);
  if (!in.ok()) return id;
  if (!std::all_of(id.begin(), id.end(), is_id_letter)) {
    in.fail(key,
            in_quotes(key) + " has a letter that an id cannot have",
            "use a to z, A to Z, digits, \"_\", \"-\" and \".\"");
  }
  if (std::find(taken.begin(), taken.end(), id) != taken.end()) {
    in.fail(key, in_quotes(id) + " is used twice", "give each an id of its own");
  }
  return id;
}

void fail_unknown(TomlReader& in,
                  std::string_view key,
                  std::string_view kind,
                  const std::string& name,
                  std::span<const std::string> known) {
  std::string next("add one with this id");
  if (!known.empty()) {
    const std::vector<std::string_view> words(known.begin(), known.end());
    // A list of thousands of ids is no help.
    constexpr std::size_t kShown = 8;
    const std::vector<std::string_view> nearest = nearest_words(name, words, kShown);
    next = suggestion(name, nearest);
  }
  in.fail(key,
          std::string("there is no ").append(kind).append(" ") + in_quotes(name),
          std::move(next));
}

void check_count(TomlReader& in, std::string_view key, std::size_t max) {
  if (in.count(key) <= max) return;
  std::string cause = "it has ";
  append_exact(cause, static_cast<int>(in.count(key)));
  cause.append(" tables of ").append(in_quotes(key)).append(", more than ");
  append_exact(cause, static_cast<int>(max));
  in.fail(key, std::move(cause), "divide the scene");
}

std::size_t read_choice_of(TomlReader& in,
                           std::string_view key,
                           std::span<const std::string_view> words) {
  return recipe::read_choice(in, key, words);
}

void check_pairs(TomlReader& in,
                 std::string_view key,
                 const Scene& scene,
                 const std::string& users,
                 const std::string& partners,
                 const std::string& what) {
  const auto of_users = members_of(scene, users);
  const auto of_partners = members_of(scene, partners);
  if (!in.ok() || !of_users || !of_partners) return;
  if (of_partners->count == 1 || of_partners->count == of_users->count) return;
  std::string cause = in_quotes(users) + " has ";
  append_exact(cause, static_cast<int>(of_users->count));
  cause += of_users->count == 1 ? " body" : " bodies";
  cause += ", and " + what + " is on ";
  append_exact(cause, static_cast<int>(of_partners->count));
  in.fail(std::string(key),
          std::move(cause),
          "name groups with equal counts, or one member of the other group");
}

void check_target_pairs(TomlReader& in,
                        std::string_view key,
                        const Scene& scene,
                        const std::string& users,
                        const std::string& target) {
  const SceneTarget* const found = scene.target(target);
  if (found == nullptr) return;
  const auto* const path = std::get_if<BodyPointPath>(&found->path);
  if (path == nullptr) return;
  check_pairs(in, key, scene, users, path->body, "the target " + in_quotes(target));
}

}  // namespace marey::recordings::stage
