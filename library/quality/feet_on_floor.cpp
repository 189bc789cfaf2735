// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/feet_on_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/degrees.h"

namespace marey::library {
namespace {

constexpr double kLow_m = 0.02;
constexpr double kHeightError_m = 0.0006;
constexpr double kSlow_legs_s = 0.15;
constexpr double kMinExtent_m = 0.08;
constexpr double kSureErrors = 3.0;
// Mean lean to a side of straight gaits is below this angle.
constexpr double kSideLean_rad = 1.0 * kRadiansPerDegree;
constexpr double kStraight = 0.97;
// Forward of the ankles by this angle, the centre of mass of a standing body is in the
// mean of captured styles.
constexpr double kUpright_rad = 5.0 * kRadiansPerDegree;

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
  for (std::size_t t = 1; t + 1 < count; ++t) {
    for (std::size_t s = 0; s < 2; ++s) {
      const auto& ball = frames.ball_in_world[s];
      if (ball[t].y > low_m[s]) continue;
      // The smaller step: a stance of a run at 30 Hz has few still frames.
      const double step_m = std::min(glm::distance(level(ball[t + 1]), level(ball[t])),
                                     glm::distance(level(ball[t]), level(ball[t - 1])));
      slower[t] = std::min(slower[t], 100.0 * frames.hz * step_m);
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

// Places at which a heel or a ball is slow for 0.1 s, at any height: on a tilted floor
// the heights of contacts differ by more than a detector of contacts accepts.
std::vector<ContactPlace> slow_places(const QualityFrames& frames) {
  std::vector<ContactPlace> out;
  const double max_step_m = kSlow_legs_s * frames.leg_m / frames.hz;
  const double min_frames = std::max(2.0, std::round(0.1 * frames.hz));
  for (int part = 0; part < 4; ++part) {
    const std::vector<glm::dvec3>& path =
        part % 2 == 0 ? frames[foot_of(part / 2)].p_in_world
                      : frames.ball_in_world[static_cast<std::size_t>(part) / 2];
    for (std::size_t t = 1; t < path.size(); ++t) {
      ContactPlace place{part, {static_cast<int>(t), static_cast<int>(t)}};
      double count = 0.0;
      for (; t < path.size() && glm::distance(path[t], path[t - 1]) < max_step_m; ++t) {
        place.mean += path[t];
        count += 1.0;
      }
      if (count < min_frames) continue;
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

// Slope of heights over places along `direction`, less three standard errors.
double sure_slope(const std::vector<ContactPlace>& places,
                  const std::array<glm::dvec3, 2>& means,
                  const glm::dvec2& direction) {
  double uu = 0.0;
  double uy = 0.0;
  double yy = 0.0;
  for (const ContactPlace& place : places) {
    const glm::dvec3 d = place.mean - means[static_cast<std::size_t>(place.part % 2)];
    const double u = glm::dot(level(d), direction);
    uu += u * u;
    uy += u * d.y;
    yy += d.y * d.y;
  }
  if (uu < kMinExtent_m * kMinExtent_m || places.size() < 4) return 0.0;
  const double slope = uy / uu;
  const double freedom = std::max(1.0, static_cast<double>(places.size()) - 3.0);
  const double error_m =
      std::max(kHeightError_m, std::sqrt(std::max(0.0, yy - slope * uy) / freedom));
  return std::max(0.0, std::abs(slope) - kSureErrors * error_m / std::sqrt(uu));
}

double slope_of_places_rad(const std::vector<ContactPlace>& places) {
  std::array<glm::dvec3, 2> means{};
  std::array<double, 2> counts{};
  for (const ContactPlace& place : places) {
    means[static_cast<std::size_t>(place.part % 2)] += place.mean;
    counts[static_cast<std::size_t>(place.part % 2)] += 1.0;
  }
  for (std::size_t k = 0; k < 2; ++k) means[k] /= std::max(1.0, counts[k]);
  glm::dvec3 scatter(0.0);  // xx, zz, xz
  for (const ContactPlace& place : places) {
    const glm::dvec2 d =
        level(place.mean - means[static_cast<std::size_t>(place.part % 2)]);
    scatter += glm::dvec3(d.x * d.x, d.y * d.y, d.x * d.y);
  }
  const double angle_rad = 0.5 * std::atan2(2.0 * scatter.z, scatter.x - scatter.y);
  const glm::dvec2 first(std::cos(angle_rad), std::sin(angle_rad));
  const glm::dvec2 second(-first.y, first.x);
  return std::atan(
      std::hypot(sure_slope(places, means, first), sure_slope(places, means, second)));
}

// Lean of a standing body, forward or backward: that of its soles or that of its centre
// of mass over the ankles, the smaller one if both lean the same way, since either alone
// has other causes (shoes, styles). 0 if it does not stand on both feet half of the time.
double lean_rad(const QualityFrames& frames, const std::vector<FootParts>& contacts) {
  double sole = 0.0;
  double body = 0.0;
  double count = 0.0;
  std::array<const BonePath*, 2> feet{&frames[foot_of(0)], &frames[foot_of(1)]};
  for (std::size_t t = 0; t < contacts.size(); ++t) {
    if (contacts[t] != FootParts{1, 1, 1, 1}) continue;
    glm::dvec3 ankles(0.0);
    glm::dvec3 front(0.0);
    glm::dvec3 up(0.0);
    for (std::size_t s = 0; s < 2; ++s) {
      const glm::dvec3& ankle = feet[s]->p_in_world[t];
      ankles += 0.5 * ankle;
      front += frames.ball_in_world[s][t] - ankle;
      up += feet[s]->world_from_t_pose[t] * glm::dvec3(0.0, 0.5, 0.0);
    }
    front.y = 0.0;
    const glm::dvec3 com = frames.com_in_world[t] - ankles;
    if (glm::length(front) <= 0.0 || com.y <= 0.0) continue;
    front = glm::normalize(front);
    sole += std::asin(glm::dot(up, front));
    body += std::atan2(glm::dot(com, front), com.y) - kUpright_rad;
    count += 1.0;
  }
  if (count < 1.0 || 2.0 * count < frames.count || sole * body <= 0.0) return 0.0;
  return std::min(std::abs(sole), std::abs(body)) / count;
}

// Returns the lean to a side of a body on a straight path, less that of captured gaits.
// It is the angle of the centre of mass over the middle of the ankles. 0 if the body
// turns or stands.
double side_lean_rad(const QualityFrames& frames,
                     const std::vector<FootParts>& contacts) {
  const BonePath& left = frames[HumanBone::kLeftUpperLeg];
  const BonePath& right = frames[HumanBone::kRightUpperLeg];
  glm::dvec3 mean(0.0);
  double lean = 0.0;
  double count = 0.0;
  int standing = 0;
  for (std::size_t t = 0; t < static_cast<std::size_t>(frames.count); ++t) {
    glm::dvec3 across = left.p_in_world[t] - right.p_in_world[t];
    across.y = 0.0;
    if (glm::length(across) <= 0.0) continue;
    across = glm::normalize(across);
    const glm::dvec3 com =
        frames.com_in_world[t] -
        0.5 * (frames[foot_of(0)].p_in_world[t] + frames[foot_of(1)].p_in_world[t]);
    if (com.y <= 0.5 * frames.leg_m) continue;
    mean += across;
    lean += std::atan2(glm::dot(com, across), com.y);
    count += 1.0;
    if (t < contacts.size() && contacts[t] == FootParts{1, 1, 1, 1}) ++standing;
  }
  if (2.0 * count < frames.count || glm::length(mean) < kStraight * count ||
      2 * standing > frames.count) {
    return 0.0;
  }
  return std::max(0.0, std::abs(lean / count) - kSideLean_rad);
}

FoundFigure measure_tilt(const QualityFrames& frames,
                         const std::vector<FootParts>& contacts,
                         const std::vector<ContactPlace>& places,
                         double warn) {
  FoundFigure out{"tilt_deg"};
  out.value = kDegreesPerRadian * std::max({slope_of_places_rad(places),
                                            lean_rad(frames, contacts),
                                            side_lean_rad(frames, contacts)});
  if (out.value > warn) {
    out.frames = FrameRange{0, frames.count - 1};
    out.places.push_back({*out.frames, std::nullopt, out.value});
  }
  return out;
}

}  // namespace

std::array<FoundFigure, 5> measure_feet_on_floor(const QualityFrames& frames,
                                                 const std::vector<FootParts>& contacts,
                                                 const QualityLimits& limits) {
  const std::vector<ContactPlace> places = contact_places(frames, contacts);
  auto heights = measure_heights(frames, contacts, limits);
  return {measure_slide(frames, limits["slide_cm_s"].warn),
          measure_drift(places, limits["drift_mm"].warn),
          std::move(heights[0]),
          std::move(heights[1]),
          measure_tilt(frames, contacts, slow_places(frames), limits["tilt_deg"].warn)};
}

}  // namespace marey::library
