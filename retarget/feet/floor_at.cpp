// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/floor_at.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/base/smooth_step.h"

namespace marey::retarget {
namespace {

// Returns the speed at a key between two stretches. [m/s]
glm::dvec3 speed_at(const std::vector<FloorKey>& path, std::size_t k) {
  glm::dvec3 speed(0.0);
  if (k == 0 || k + 1 == path.size()) return speed;
  const auto along = [&](std::size_t i) {
    return (path[i + 1].moved_m - path[i].moved_m) /
           (path[i + 1].time_s - path[i].time_s);
  };
  const glm::dvec3 before = along(k - 1);
  const glm::dvec3 after = along(k);
  for (const int axis : {0, 1, 2}) {
    const double product = before[axis] * after[axis];
    if (product > 0.0) speed[axis] = 2.0 * product / (before[axis] + after[axis]);
  }
  return speed;
}

}  // namespace

glm::dvec3 moved_at(const FloorPart& part, double time_s) {
  const std::vector<FloorKey>& path = part.path;
  if (path.empty()) return glm::dvec3(0.0);
  if (time_s <= path.front().time_s) return path.front().moved_m;
  if (time_s >= path.back().time_s) return path.back().moved_m;
  const auto after = std::upper_bound(
      path.begin(), path.end(), time_s, [](double t, const FloorKey& key) {
        return t < key.time_s;
      });
  const auto k = static_cast<std::size_t>(after - path.begin()) - 1;
  const double span_s = path[k + 1].time_s - path[k].time_s;
  const double u = (time_s - path[k].time_s) / span_s;
  const double u3 = u * u * u;
  const double of_first = u - u3 * (6.0 - u * (8.0 - 3.0 * u));
  const double of_last = -u3 * (4.0 - u * (7.0 - 3.0 * u));
  return path[k].moved_m + smooth_step(u) * (path[k + 1].moved_m - path[k].moved_m) +
         span_s * (of_first * speed_at(path, k) + of_last * speed_at(path, k + 1));
}

FloorSpot plane_at(const Floor& floor,
                   FloorPartIndex part,
                   const glm::dvec2& xz_in_world,
                   double time_s) {
  if (!part) return {part, floor.base_height_m, glm::dvec3(0, 1, 0)};
  const FloorPart& on = floor.parts[*part];
  const glm::dvec3 moved = moved_at(on, time_s);
  const glm::dvec2 middle =
      0.5 * (on.min_xz_m + on.max_xz_m) + glm::dvec2(moved.x, moved.z);
  FloorSpot spot{part, on.height_m + moved.y, glm::dvec3(0, 1, 0)};
  if (on.slope == glm::dvec2(0.0)) return spot;
  spot.height_m += glm::dot(on.slope, xz_in_world - middle);
  spot.normal_in_world = glm::normalize(glm::dvec3(-on.slope.x, 1.0, -on.slope.y));
  return spot;
}

FloorSpot floor_at(const Floor& floor, const glm::dvec2& xz_in_world, double time_s) {
  FloorSpot best;
  bool found = false;
  for (std::size_t i = 0; i < floor.parts.size(); ++i) {
    const FloorPart& part = floor.parts[i];
    const glm::dvec3 moved = moved_at(part, time_s);
    const glm::dvec2 p = xz_in_world - glm::dvec2(moved.x, moved.z);
    if (p.x < part.min_xz_m.x || p.x > part.max_xz_m.x) continue;
    if (p.y < part.min_xz_m.y || p.y > part.max_xz_m.y) continue;
    const FloorSpot spot = plane_at(floor, i, xz_in_world, time_s);
    if (found && spot.height_m <= best.height_m) continue;
    best = spot;
    found = true;
  }
  return found ? best : plane_at(floor, std::nullopt, xz_in_world, time_s);
}

}  // namespace marey::retarget
