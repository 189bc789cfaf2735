// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/travel_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "core/signal/smoothing_spline.h"

namespace marey::edit {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Returns the median time between two stances of one foot.
double cycle_of(const EditState& state) {
  std::vector<double> steps_s;
  for (const FootContacts& foot : state.contacts.feet) {
    for (std::size_t i = 1; i < foot.stance.size(); ++i) {
      steps_s.push_back((foot.stance[i].first - foot.stance[i - 1].first) /
                        state.motion.rate.hz);
    }
  }
  if (steps_s.empty()) return 1.0;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  // Stances that are longer apart are not steps of one gait.
  constexpr double kMin_s = 0.3;
  constexpr double kMax_s = 2.5;
  return std::clamp(*middle, kMin_s, kMax_s);
}

std::array<std::vector<double>, 2> hips_on_floor(const EditState& state) {
  std::array<std::vector<double>, 2> out;
  const Skeleton& skeleton = state.motion.skeleton;
  std::vector<RigidTransform> joints(skeleton.joints.size());
  for (const Pose& pose : state.motion.poses) {
    world_from_joints(skeleton, pose, joints);
    const glm::dvec3& hips = joints[index(state.map.hips())].translation;
    out[0].push_back(hips.x);
    out[1].push_back(hips.z);
  }
  return out;
}

void low_pass(std::array<std::vector<double>, 2>& channels, double cycle_s, double hz) {
  const SplineOptions options;
  const std::size_t count = channels[0].size();
  if (count < 2 * static_cast<std::size_t>(options.order) + 1) return;
  const double penalty = std::min(penalty_of_half_power(0.5 / cycle_s, hz, options),
                                  max_spline_penalty(options));
  SmoothingSpline spline(count, options);
  spline.set_penalty(penalty);
  for (auto& channel : channels) {
    // Relative to its first value, so that the place of the motion adds no rounding.
    const double start = channel.front();
    for (double& value : channel) value -= start;
    (void)spline.fit(channel, channel);
    for (double& value : channel) value += start;
  }
}

/// Fills the headings of frames that have none from their neighbours.
std::vector<double> joined_headings(const std::vector<std::optional<double>>& known) {
  std::vector<double> out(known.size(), 0.0);
  std::optional<std::size_t> before;
  for (std::size_t t = 0; t < known.size(); ++t) {
    if (!known[t]) continue;
    const double last = before ? out[*before] : *known[t];
    out[t] = *known[t] + kTwoPi * std::round((last - *known[t]) / kTwoPi);
    for (std::size_t k = before ? *before + 1 : 0; k < t; ++k) {
      const double share =
          before ? static_cast<double>(k - *before) / static_cast<double>(t - *before)
                 : 1.0;
      out[k] = last + share * (out[t] - last);
    }
    before = t;
  }
  if (before) {
    std::fill(
        out.begin() + static_cast<std::ptrdiff_t>(*before) + 1, out.end(), out[*before]);
  }
  return out;
}

std::vector<double> headings_of(const std::vector<glm::dvec2>& path,
                                double hz,
                                double leg_length_m) {
  const std::size_t count = path.size();
  std::vector<glm::dvec2> velocity(count, glm::dvec2(0.0));
  std::vector<double> speeds;
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t a = t == 0 ? 0 : t - 1;
    const std::size_t b = std::min(t + 1, count - 1);
    if (b > a) velocity[t] = (path[b] - path[a]) * (hz / static_cast<double>(b - a));
    speeds.push_back(glm::length(velocity[t]));
  }
  std::vector<double> sorted = speeds;
  std::sort(sorted.begin(), sorted.end());
  // Slower than this, sway determines the direction. Shares of a leg length per second,
  // and of the speed that a quarter of the frames exceeds.
  constexpr double kSlowInLegs = 0.1;
  constexpr double kSlowShare = 0.25;
  const double slow =
      std::max(kSlowInLegs * leg_length_m, kSlowShare * sorted[3 * count / 4]);
  std::vector<std::optional<double>> known(count);
  for (std::size_t t = 0; t < count; ++t) {
    if (speeds[t] > slow) known[t] = std::atan2(velocity[t].x, velocity[t].y);
  }
  return joined_headings(known);
}

}  // namespace

glm::dvec2 direction_of(double heading_rad) {
  return {std::sin(heading_rad), std::cos(heading_rad)};
}

glm::dvec2 turned(const glm::dvec2& v, double turn_rad) {
  const double c = std::cos(turn_rad);
  const double s = std::sin(turn_rad);
  return {c * v.x + s * v.y, c * v.y - s * v.x};
}

TravelPath find_travel_path(const EditState& state) {
  TravelPath out;
  if (state.motion.poses.empty()) return out;
  out.cycle_s = cycle_of(state);
  auto channels = hips_on_floor(state);
  low_pass(channels, out.cycle_s, state.motion.rate.hz);
  for (std::size_t t = 0; t < channels[0].size(); ++t) {
    out.origin_m.emplace_back(channels[0][t], channels[1][t]);
    out.way_m.push_back(t == 0 ? 0.0
                               : out.way_m.back() +
                                     glm::distance(out.origin_m[t], out.origin_m[t - 1]));
  }
  out.heading_rad =
      headings_of(out.origin_m, state.motion.rate.hz, state.map.leg_length_m);
  return out;
}

double extent_m(const TravelPath& path, const FrameRange& frames) {
  constexpr int kDirections = 8;
  double widest = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const glm::dvec2 along = direction_of(std::numbers::pi * k / kDirections);
    double low = 0.0;
    double high = 0.0;
    for (int frame = frames.first; frame <= frames.last; ++frame) {
      const glm::dvec2 from_first = path.origin_m[static_cast<std::size_t>(frame)] -
                                    path.origin_m[static_cast<std::size_t>(frames.first)];
      low = std::min(low, glm::dot(from_first, along));
      high = std::max(high, glm::dot(from_first, along));
    }
    widest = std::max(widest, high - low);
  }
  return widest;
}

}  // namespace marey::edit
