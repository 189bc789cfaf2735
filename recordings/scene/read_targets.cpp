// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_targets.h"

#include <array>
#include <string_view>
#include <utility>

#include "core/base/degrees.h"
#include "core/base/in_quotes.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/read_bodies.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings::stage {
namespace {

constexpr std::array<std::string_view, 4> kPathWords{
    "fixed", "lissajous", "polyline", "body"};
constexpr std::array<std::string_view, 2> kFrameWords{"world", "body"};
constexpr std::array<std::string_view, 3> kCourseWords{"linear", "smooth", "hold"};

glm::dvec3 needed_vector(TomlReader& in, std::string_view key, const Limits& limits) {
  const std::vector<double> v = recipe::read_numbers(in, key, 3, limits);
  return {v[0], v[1], v[2]};
}

FixedPath read_fixed(TomlReader& in) {
  return {needed_vector(in, "position_m", kPlace)};
}

LissajousPath read_lissajous(TomlReader& in) {
  LissajousPath path;
  path.middle_m = needed_vector(in, "middle_m", kPlace);
  path.amplitude_m = needed_vector(in, "amplitude_m", kPlace);
  path.frequency_hz = needed_vector(in, "frequency_hz", kFrequency);
  read_vector(in, "phase_deg", path.phase_rad, kAngle);
  path.phase_rad *= kRadiansPerDegree;
  return path;
}

PolylinePath read_polyline(TomlReader& in) {
  PolylinePath path;
  const std::size_t count = in.count("times_s");
  path.times_s = recipe::read_numbers(in, "times_s", count, kTime);
  const std::vector<double> p = in.matrix("positions_m", count, 3);
  recipe::check_numbers(in, "positions_m", p, kPlace);
  if (count == 0) in.fail("times_s", "the polyline has no point", "give one or more");
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0 && path.times_s[k] <= path.times_s[k - 1]) {
      in.fail("times_s", "\"times_s\" does not ascend", "give each time once, in order");
    }
    path.positions_m.emplace_back(p[3 * k], p[3 * k + 1], p[3 * k + 2]);
  }
  read_word(in, "course", path.course, kCourseWords);
  return path;
}

BodyPointPath read_body_point(TomlReader& in, const Scene& scene) {
  BodyPointPath path;
  (void)read_members(in, "body", scene, path.body);
  path.point = read_point(in);
  read_boolean(in, "last_step", path.last_step);
  return path;
}

/// Allows the keys of a path of this kind.
void allow_path(TomlReader& in, std::size_t kind) {
  using KeyList = std::vector<std::string_view>;
  static const std::array<KeyList, kPathWords.size()> kKeys{
      KeyList{"position_m"},
      KeyList{"middle_m", "amplitude_m", "frequency_hz", "phase_deg"},
      KeyList{"times_s", "positions_m", "course"},
      KeyList{"body", "segment", "offset_m", "last_step"}};
  KeyList keys{"id", "path"};
  keys.insert(keys.end(), kKeys[kind].begin(), kKeys[kind].end());
  if (kPathWords[kind] != "body") {
    for (const std::string_view key : {"frame", "for_stature_m", "drag"}) {
      keys.push_back(key);
    }
  }
  in.allow(keys);
}

SceneTarget read_one_target(TomlReader& in,
                            const Scene& scene,
                            std::vector<std::string>& ids) {
  SceneTarget target;
  target.line = in.line();
  const std::size_t kind = read_choice_of(in, "path", kPathWords);
  if (!in.ok()) return target;
  allow_path(in, kind);
  target.id = read_id(in, "id", ids);
  ids.push_back(target.id);
  if (kind == 0) target.path = read_fixed(in);
  if (kind == 1) target.path = read_lissajous(in);
  if (kind == 2) target.path = read_polyline(in);
  if (kind == 3) target.path = read_body_point(in, scene);
  read_word(in, "frame", target.frame, kFrameWords);
  read_number(in, "for_stature_m", target.for_stature_m, kStature);
  read_boolean(in, "drag", target.drag);
  if (target.for_stature_m && target.frame == TargetFrame::kWorld) {
    in.fail("for_stature_m",
            "\"for_stature_m\" needs positions in the frame of a body",
            "add frame = \"body\", or remove it");
  }
  return target;
}

}  // namespace

void read_targets(TomlReader& root, Scene& scene) {
  check_count(root, "target", kMaxTables);
  std::vector<std::string> ids;
  for (TomlReader& table : root.tables("target")) {
    SceneTarget target = read_one_target(table, scene, ids);
    if (!root.ok()) return;
    scene.targets.push_back(std::move(target));
  }
}

std::string read_target_id(TomlReader& in, std::string_view key, const Scene& scene) {
  std::string id = recipe::read_line(in, key, kMaxIdBytes);
  if (!in.ok() || scene.target(id) != nullptr) return id;
  std::vector<std::string> ids;
  for (const SceneTarget& target : scene.targets) ids.push_back(target.id);
  fail_unknown(in, key, "target", id, ids);
  return id;
}

}  // namespace marey::recordings::stage
