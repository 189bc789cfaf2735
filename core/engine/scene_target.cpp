// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/scene_target.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/smooth_step.h"

namespace marey {
namespace {

glm::dvec3 position_at(const LissajousPath& path, double time_s) {
  glm::dvec3 p = path.middle_m;
  for (const int axis : {0, 1, 2}) {
    const double turns = path.frequency_hz[axis] * time_s;
    p[axis] += path.amplitude_m[axis] *
               std::sin(2.0 * std::numbers::pi * turns + path.phase_rad[axis]);
  }
  return p;
}

glm::dvec3 position_at(const PolylinePath& path, double time_s) {
  const auto next = std::upper_bound(path.times_s.begin(), path.times_s.end(), time_s);
  if (next == path.times_s.begin()) return path.positions_m.front();
  if (next == path.times_s.end()) return path.positions_m.back();
  const auto k = static_cast<std::size_t>(next - path.times_s.begin());
  const glm::dvec3& before = path.positions_m[k - 1];
  if (path.course == PathCourse::kHold) return before;
  double share = (time_s - path.times_s[k - 1]) / (*next - path.times_s[k - 1]);
  if (path.course == PathCourse::kSmooth) share = smooth_step(share);
  return before + share * (path.positions_m[k] - before);
}

}  // namespace

std::optional<glm::dvec3> path_at(const TargetPath& path, double time_s) {
  if (const auto* fixed = std::get_if<FixedPath>(&path)) return fixed->position_m;
  if (const auto* lissajous = std::get_if<LissajousPath>(&path)) {
    return position_at(*lissajous, time_s);
  }
  if (const auto* polyline = std::get_if<PolylinePath>(&path)) {
    return position_at(*polyline, time_s);
  }
  return std::nullopt;
}

}  // namespace marey
