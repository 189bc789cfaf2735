// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/landing.h"

#include <algorithm>
#include <cmath>

#include "engine/clips/sample_clip.h"

namespace marey::engine {
namespace {

// Interval of the search, in which a contact must last to be seen, and precision of the
// time that is found.
constexpr double kSearch_s = 0.01;
constexpr int kHalvings = 6;
// Interval of the difference that is the velocity.
constexpr double kBack_s = 0.004;

bool bears_at(const BlendPlayer& blend, std::size_t side, double time_s) {
  const PerFootPart bears = blend.predict_bears(time_s);
  return std::max(bears[2 * side], bears[2 * side + 1]) > kBearsAbove;
}

std::optional<double> landing_time_s(const BlendPlayer& blend,
                                     std::size_t side,
                                     double time_s,
                                     double within_s) {
  if (bears_at(blend, side, time_s)) return std::nullopt;
  double before_s = time_s;
  while (before_s < time_s + within_s) {
    double after_s = std::min(before_s + kSearch_s, time_s + within_s);
    if (!bears_at(blend, side, after_s)) {
      before_s = after_s;
      continue;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_s = 0.5 * (before_s + after_s);
      (bears_at(blend, side, middle_s) ? after_s : before_s) = middle_s;
    }
    return after_s;
  }
  return std::nullopt;
}

}  // namespace

std::optional<FootReference::Landing> next_landing(const BlendPlayer& blend,
                                                   std::size_t side,
                                                   double time_s,
                                                   double within_s) {
  const auto at_s = landing_time_s(blend, side, time_s, within_s);
  if (!at_s) return std::nullopt;
  const Rig& rig = blend.rig();
  BlendPosture posture;
  RootPlace root;
  const RootPlace start = blend.root();
  // From kBack_s before the landing, the root is taken to be where it is now.
  if (!blend.predict(*at_s - 2.0 * kBack_s, *at_s - kBack_s, posture, root)) {
    return std::nullopt;
  }
  const auto ankle_at = [&](const RootPlace& place) {
    const glm::dvec3 p = rig.leg_length_m * foot_places(rig, posture).ankle[side];
    const double c = std::cos(place.heading_rad);
    const double s = std::sin(place.heading_rad);
    return glm::dvec3(place.x_m + c * p.x + s * p.z,
                      p.y + rig.leg_length_m * static_cast<double>(posture.height_legs),
                      place.z_m - s * p.x + c * p.z);
  };
  const glm::dvec3 before = ankle_at(start);
  (void)blend.predict(*at_s - kBack_s, *at_s, posture, root);
  FootReference::Landing landing;
  landing.in_s = *at_s - time_s;
  landing.ankle_in_world = ankle_at(root);
  landing.velocity_m_s = (landing.ankle_in_world - before) / kBack_s;
  return landing;
}

}  // namespace marey::engine
