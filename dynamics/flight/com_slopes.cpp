// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/com_slopes.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace marey::dynamics {

ComSlopes com_slopes(std::span<const glm::dvec3> com_in_world, FrameRate rate) {
  MAREY_ASSERT(rate.hz > 0.0);
  const auto count = static_cast<int>(com_in_world.size());
  ComSlopes out;
  const auto size = com_in_world.size();
  for (const glm::dvec3& p : com_in_world) out.height_m.push_back(p.y);
  out.up_m_s.assign(size, 0.0);
  out.up_m_s2.assign(size, 0.0);
  out.velocity_m_s.assign(size, glm::dvec3(0.0));
  const int reach =
      std::min(std::max(1, static_cast<int>(std::lround(0.5 * kSlopeWindow_s * rate.hz))),
               (count - 1) / 2);
  if (reach < 1) return out;
  // Sums of the second and fourth powers of the frames' distances from the middle.
  double s2 = 0.0;
  double s4 = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    s2 += static_cast<double>(k) * k;
    s4 += static_cast<double>(k) * k * k * k;
  }
  const double n = 2.0 * reach + 1.0;
  for (int t = 0; t < count; ++t) {
    const int middle = std::clamp(t, reach, count - 1 - reach);
    const glm::dvec3 origin = com_in_world[static_cast<std::size_t>(middle)];
    glm::dvec3 sum(0.0);
    glm::dvec3 first(0.0);
    glm::dvec3 second(0.0);
    for (int k = -reach; k <= reach; ++k) {
      const glm::dvec3 p = com_in_world[static_cast<std::size_t>(middle + k)] - origin;
      sum += p;
      first += static_cast<double>(k) * p;
      second += static_cast<double>(k) * k * p;
    }
    const glm::dvec3 slope = first / s2;
    const glm::dvec3 bend = (n * second - s2 * sum) / (n * s4 - s2 * s2);
    const glm::dvec3 value = (sum - s2 * bend) / n;
    const double at = t - middle;
    const auto i = static_cast<std::size_t>(t);
    out.height_m[i] = (origin + value + at * slope + at * at * bend).y;
    out.velocity_m_s[i] = (slope + 2.0 * at * bend) * rate.hz;
    out.up_m_s[i] = out.velocity_m_s[i].y;
    out.up_m_s2[i] = 2.0 * bend.y * rate.hz * rate.hz;
  }
  return out;
}

}  // namespace marey::dynamics
