// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/feet_on_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace marey::library {
namespace {

constexpr double kLow_m = 0.02;
constexpr double kStep_s = 1.0 / 60.0;

glm::dvec2 level(const glm::dvec3& p) {
  return {p.x, p.z};
}

FoundFigure measure_slide(const QualityFrames& frames, double warn) {
  FoundFigure out{"slide_cm_s"};
  if (frames.count < 3) return out;
  const auto count = static_cast<std::size_t>(frames.count);
  std::array<double, 2> low_m{};
  std::vector<double> scratch(count);
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t t = 0; t < count; ++t) scratch[t] = frames.ball_in_world[s][t].y;
    low_m[s] = quantile_in_place(scratch, 0.05) + kLow_m;
  }
  constexpr double kNone = std::numeric_limits<double>::max();
  std::vector<double> slower(count, kNone);
  scratch.clear();
  const auto reach =
      static_cast<std::size_t>(std::max(1L, std::lround(kStep_s * frames.hz)));
  for (std::size_t t = reach; t + reach < count; ++t) {
    for (std::size_t s = 0; s < 2; ++s) {
      const auto& ball = frames.ball_in_world[s];
      if (ball[t].y > low_m[s]) continue;
      // The smaller step: a stance of a run at 30 Hz has few still frames.
      const double step_m =
          std::min(glm::distance(level(ball[t + reach]), level(ball[t])),
                   glm::distance(level(ball[t]), level(ball[t - reach])));
      slower[t] =
          std::min(slower[t], 100.0 * frames.hz * step_m / static_cast<double>(reach));
    }
    if (slower[t] < kNone) scratch.push_back(slower[t]);
  }
  out.value = quantile_in_place(scratch, 0.25);
  if (out.value <= warn) return out;
  const int gap = static_cast<int>(std::lround(0.1 * frames.hz));
  for (int t = 1; t + 1 < frames.count; ++t) {
    const double speed = slower[static_cast<std::size_t>(t)];
    if (speed <= warn || speed == kNone) continue;
    add_place(out.places, {{t, t}, std::nullopt, speed}, gap);
  }
  for (const FoundPlace& place : out.places) {
    if (!out.frames ||
        place.frames.last - place.frames.first > out.frames->last - out.frames->first) {
      out.frames = place.frames;
    }
  }
  return out;
}

/// One contact of a heel or a ball.
struct ContactPlace {
  int part = 0;  ///< As in FootParts.
  FrameRange frames;
  glm::dvec3 mean{0.0};
  double drift_m = 0.0;
};

HumanBone bone_of(int part) {
  return part % 2 == 0 ? foot_of(part / 2) : toes_of(part / 2);
}

std::vector<ContactPlace> contact_places(const QualityFrames& frames,
                                         const std::vector<FootParts>& contacts) {
  std::vector<ContactPlace> out;
  for (int part = 0; part < 4; ++part) {
    const auto p = static_cast<std::size_t>(part);
    const std::vector<glm::dvec3>& path = part % 2 == 0
                                              ? frames[foot_of(part / 2)].p_in_world
                                              : frames.ball_in_world[p / 2];
    if (path.empty()) continue;
    for (std::size_t t = 0; t < contacts.size(); ++t) {
      if (contacts[t][p] == 0) continue;
      ContactPlace place{part, {static_cast<int>(t), static_cast<int>(t)}};
      const glm::dvec2 start = level(path[t]);
      double count = 0.0;
      for (; t < contacts.size() && contacts[t][p] != 0; ++t) {
        place.mean += path[t];
        place.drift_m = std::max(place.drift_m, glm::distance(level(path[t]), start));
        place.frames.last = static_cast<int>(t);
        count += 1.0;
      }
      place.mean /= count;
      out.push_back(place);
    }
  }
  return out;
}

FoundFigure measure_drift(const std::vector<ContactPlace>& places, double warn) {
  FoundFigure out{"drift_mm"};
  for (const ContactPlace& place : places) {
    const double drift_mm = 1000.0 * place.drift_m;
    if (drift_mm > out.value) {
      out.value = drift_mm;
      out.bone = bone_of(place.part);
      out.frames = place.frames;
    }
    if (drift_mm > warn) {
      out.places.push_back({place.frames, bone_of(place.part), drift_mm});
    }
  }
  return out;
}

std::array<FoundFigure, 2> measure_heights(const QualityFrames& frames,
                                           const std::vector<FootParts>& contacts,
                                           const QualityLimits& limits) {
  FoundFigure floats{"float_mm"};
  FoundFigure sinks{"sink_mm"};
  std::vector<double> bearing_m;
  std::vector<double> lower_m(static_cast<std::size_t>(frames.count));
  bearing_m.reserve(contacts.size());
  for (std::size_t t = 0; t < lower_m.size(); ++t) {
    lower_m[t] = std::min(frames.sole_m[0][t], frames.sole_m[1][t]);
    const bool bears = t < contacts.size() && contacts[t] != FootParts{};
    if (bears) bearing_m.push_back(lower_m[t]);
  }
  floats.value = std::max(0.0, 1000.0 * quantile_in_place(bearing_m, 0.05));
  const double warn_mm = limits["sink_mm"].warn;
  for (int t = 0; t < frames.count; ++t) {
    const double depth_mm = -1000.0 * lower_m[static_cast<std::size_t>(t)];
    if (depth_mm > warn_mm) add_place(sinks.places, {{t, t}, std::nullopt, depth_mm}, 2);
  }
  sinks.value = std::max(0.0, -1000.0 * quantile_in_place(lower_m, 0.01));
  if (sinks.value <= warn_mm) sinks.places.clear();
  if (!sinks.places.empty()) sinks.frames = sinks.places.front().frames;
  if (floats.value > limits["float_mm"].warn) {
    floats.frames = FrameRange{0, frames.count - 1};
    floats.places.push_back({*floats.frames, std::nullopt, floats.value});
  }
  return {std::move(floats), std::move(sinks)};
}

}  // namespace

std::array<FoundFigure, 4> measure_feet_on_floor(const QualityFrames& frames,
                                                 const std::vector<FootParts>& contacts,
                                                 const QualityLimits& limits) {
  const std::vector<ContactPlace> places = contact_places(frames, contacts);
  auto heights = measure_heights(frames, contacts, limits);
  return {measure_slide(frames, limits["slide_cm_s"].warn),
          measure_drift(places, limits["drift_mm"].warn),
          std::move(heights[0]),
          std::move(heights[1])};
}

}  // namespace marey::library
