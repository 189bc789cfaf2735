// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/transition/entry_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "engine/clips/sample_clip.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kDefaultHalfLife_s = 0.1;
// Half the time of the central difference of places. [s]
constexpr float kDifference_s = 0.004F;

// Feet, hips, hands and head in the heading frame, above the floor.
constexpr std::size_t kPointCount = 6;
using Points = std::array<glm::dvec3, kPointCount>;

Points points_of(const Rig& rig, const BlendPosture& posture) {
  const FootPlaces feet = foot_places(rig, posture);
  const UpperPlaces upper = upper_places(rig, posture);
  Points points{feet.ankle[0],
                feet.ankle[1],
                glm::dvec3(0.0),
                upper.wrist[0],
                upper.wrist[1],
                upper.head};
  for (glm::dvec3& point : points) {
    point.y += static_cast<double>(posture.height_legs);
    point *= rig.leg_length_m;
  }
  return points;
}

struct MovingPoints {
  Points place_m{};
  Points velocity_m_s{};
};

MovingPoints moving_points(const Rig& rig,
                           const BlendPosture& posture,
                           const PostureRates& rates) {
  MovingPoints out;
  out.place_m = points_of(rig, posture);
  BlendPosture before = posture;
  BlendPosture after = posture;
  move_posture(rates, -kDifference_s, before);
  move_posture(rates, kDifference_s, after);
  const Points earlier = points_of(rig, before);
  const Points later = points_of(rig, after);
  for (std::size_t i = 0; i < kPointCount; ++i) {
    out.velocity_m_s[i] =
        (later[i] - earlier[i]) / (2.0 * static_cast<double>(kDifference_s));
  }
  return out;
}

double area_under_offset(const MovingPoints& from,
                         const MovingPoints& to,
                         double half_life_s) {
  const double y = 2.0 * 0.69314718055994530942 / half_life_s;
  double cost_m_s = 0.0;
  for (std::size_t i = 0; i < kPointCount; ++i) {
    const glm::dvec3 x = from.place_m[i] - to.place_m[i];
    const glm::dvec3 v = from.velocity_m_s[i] - to.velocity_m_s[i];
    cost_m_s += glm::length((2.0 / y) * x + (1.0 / (y * y)) * v);
  }
  return cost_m_s;
}

bool are_opposite(unsigned a, unsigned b) {
  constexpr unsigned kLeftBits = 3U;
  constexpr unsigned kRightBits = 12U;
  const auto only_left = [](unsigned bits) {
    return (bits & kLeftBits) != 0 && (bits & kRightBits) == 0;
  };
  const auto only_right = [](unsigned bits) {
    return (bits & kLeftBits) == 0 && (bits & kRightBits) != 0;
  };
  return (only_left(a) && only_right(b)) || (only_right(a) && only_left(b));
}

PostureRates rates_of_frame(const MotionClip& clip, std::size_t frame) {
  const std::size_t last = clip.frames.size() - 1;
  std::size_t before = frame > 0 ? frame - 1 : 0;
  std::size_t after = std::min(frame + 1, last);
  float steps = static_cast<float>(after - before);
  if (clip.loops && last >= 2 && (frame == 0 || frame == last)) {
    before = last - 1;
    after = 1;
    steps = 2.0F;
  }
  return rates_between(clip.frames[before], clip.frames[after], steps / clip.rate_hz);
}

// True if a frame of a clip is within `entry_s` of `at_s`; in a clip that loops, of it in
// any cycle.
bool is_near(const MotionClip& clip, std::size_t frame, double at_s, double entry_s) {
  double away_s = static_cast<double>(frame) / static_cast<double>(clip.rate_hz) - at_s;
  if (clip.loops) away_s = std::remainder(away_s, clip.duration_s());
  return std::abs(away_s) <= entry_s + 1e-9;
}

}  // namespace

double entry_cost(const Rig& rig,
                  const BlendPosture& from,
                  const PostureRates& from_rates,
                  const BlendPosture& to,
                  const PostureRates& to_rates,
                  double half_life_s,
                  unsigned from_bearing,
                  unsigned to_bearing) {
  MAREY_ASSERT(half_life_s > 0.0);
  if (are_opposite(from_bearing, to_bearing)) {
    return std::numeric_limits<double>::infinity();
  }
  return area_under_offset(moving_points(rig, from, from_rates),
                           moving_points(rig, to, to_rates),
                           half_life_s);
}

double best_entry_s(const Rig& rig,
                    const BlendPosture& from,
                    const PostureRates& from_rates,
                    unsigned bearing,
                    const MotionClip& clip,
                    double at_s,
                    double entry_s,
                    bool anywhere) {
  MAREY_ASSERT(clip.frames.size() >= 2);
  const MovingPoints start = moving_points(rig, from, from_rates);
  // The last frame of a clip that loops is its first one.
  const std::size_t count = clip.frames.size() - (clip.loops ? 1 : 0);
  double best_cost = std::numeric_limits<double>::infinity();
  bool is_best_opposite = true;
  std::optional<double> best_s;
  for (std::size_t frame = 0; frame < count; ++frame) {
    if (!(anywhere && clip.loops) && !is_near(clip, frame, at_s, entry_s)) continue;
    const double time_s = static_cast<double>(frame) / static_cast<double>(clip.rate_hz);
    const bool is_opposite = are_opposite(bearing, bearing_at(clip, time_s));
    if (is_opposite && !is_best_opposite) continue;
    const double cost = area_under_offset(
        start,
        moving_points(rig, clip.frames[frame], rates_of_frame(clip, frame)),
        kDefaultHalfLife_s);
    const bool is_first_permitted = is_best_opposite && !is_opposite;
    if (best_s && !is_first_permitted && !(cost < best_cost)) continue;
    best_cost = cost;
    best_s = time_s;
    is_best_opposite = is_opposite;
  }
  return best_s.value_or(std::clamp(at_s, 0.0, clip.duration_s()));
}

}  // namespace marey::engine
