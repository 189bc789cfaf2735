// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"

namespace marey::retarget {
namespace {

constexpr glm::dvec3 kFootprintUp(0.0, 1.0, 0.0);

// Returns a direction that is level while the foot is halfway between flat on its sole
// and level from ankle to ball: it has a yaw both with raised toes and with a raised
// heel.
glm::dvec3 ahead_of(const FootPlace& place) {
  constexpr double kDown = 0.24;  // Half the slope of an average foot.
  return place.foot * glm::normalize(glm::dvec3(0, -kDown, 1));
}

glm::dvec3 level(const glm::dvec3& v) {
  return {v.x, 0.0, v.z};
}

// One stance. Frames are counted from its first.
struct FootprintStance {
  const StandingFootPath& path;
  const FrameRange& run;
  const FootMap& foot;

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(run.last - run.first + 1);
  }
  [[nodiscard]] std::size_t at(std::size_t k) const {
    return static_cast<std::size_t>(run.first) + k;
  }
  [[nodiscard]] const FootPlace& place(std::size_t k) const {
    return path.reference[at(k)];
  }
  [[nodiscard]] bool on_heel(std::size_t k) const { return path.heel[at(k)] != 0; }
  [[nodiscard]] bool on_ball(std::size_t k) const { return path.ball[at(k)] != 0; }
  [[nodiscard]] bool flat(std::size_t k) const { return on_heel(k) && on_ball(k); }
  [[nodiscard]] glm::dvec3 ball(std::size_t k) const {
    return place(k).ankle_in_world + place(k).foot * foot.ball_from_ankle_in_t_pose;
  }
};

// Returns the mean of a point over the frames that count.
template <class Counts, class Point>
std::optional<glm::dvec3> mean(const FootprintStance& stance,
                               const Counts& counts,
                               const Point& point) {
  glm::dvec3 sum(0.0);
  int n = 0;
  for (std::size_t k = 0; k < stance.count(); ++k) {
    if (!counts(k)) continue;
    sum += point(k);
    ++n;
  }
  if (n == 0) return std::nullopt;
  return sum / static_cast<double>(n);
}

// The yaw of the foot in each frame, without jumps by whole turns; interpolated where the
// foot is too steep to have one.
struct Yaws {
  std::vector<double> rad;
  std::vector<char> known;
};

Yaws yaws_of(const FootprintStance& stance) {
  constexpr double kMinCosine = 0.34;  // Cosine of 70 degrees.
  Yaws out{std::vector<double>(stance.count(), 0.0),
           std::vector<char>(stance.count(), 0)};
  std::optional<std::size_t> before;
  for (std::size_t k = 0; k < stance.count(); ++k) {
    const glm::dvec3 ahead = ahead_of(stance.place(k));
    if (glm::length(level(ahead)) < kMinCosine) continue;
    double yaw = std::atan2(ahead.x, ahead.z);
    const double last = before ? out.rad[*before] : yaw;
    yaw += 2.0 * std::numbers::pi * std::round((last - yaw) / (2.0 * std::numbers::pi));
    out.rad[k] = yaw;
    out.known[k] = 1;
    for (std::size_t j = before ? *before + 1 : 0; j < k; ++j) {
      const double share =
          before ? static_cast<double>(j - *before) / static_cast<double>(k - *before)
                 : 1.0;
      out.rad[j] = last + share * (yaw - last);
    }
    before = k;
  }
  if (before) {
    std::fill(out.rad.begin() + static_cast<std::ptrdiff_t>(*before),
              out.rad.end(),
              out.rad[*before]);
  }
  return out;
}

double slack_at(const FootprintStance& stance,
                const Yaws& yaws,
                std::size_t k,
                const FootprintOptions& options) {
  if (!yaws.known[k]) return std::numbers::pi;
  if (stance.flat(k)) return options.flat_rad;
  return stance.on_ball(k) ? options.ball_rad : options.heel_rad;
}

// Returns the single yaw of a foot that does not turn; nullopt: it turns.
std::optional<double> steady_yaw(const FootprintStance& stance,
                                 const Yaws& yaws,
                                 const FootprintOptions& options) {
  const auto ahead = [&](std::size_t k) { return ahead_of(stance.place(k)); };
  auto heading = mean(
      stance, [&](std::size_t k) { return stance.flat(k); }, ahead);
  if (!heading)
    heading = mean(
        stance, [](std::size_t) { return true; }, ahead);
  const double steady = std::atan2(heading->x, heading->z);
  for (std::size_t k = 0; k < stance.count(); ++k) {
    const double apart = std::remainder(yaws.rad[k] - steady, 2.0 * std::numbers::pi);
    if (std::abs(apart) > slack_at(stance, yaws, k, options)) return std::nullopt;
  }
  return steady;
}

// Returns the yaw that stays within the slack of the foot's and turns as little as
// possible: a backlash (play) filter, run forward and backward, averaged.
std::vector<double> following_yaws(const FootprintStance& stance,
                                   const Yaws& yaws,
                                   double hz,
                                   const FootprintOptions& options) {
  const std::size_t count = stance.count();
  std::vector<double> sum(count, 0.0);
  for (const bool backward : {false, true}) {
    double pointer = yaws.rad[backward ? count - 1 : 0];
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = backward ? count - 1 - i : i;
      const double slack = slack_at(stance, yaws, k, options);
      pointer = std::clamp(pointer, yaws.rad[k] - slack, yaws.rad[k] + slack);
      sum[k] += 0.5 * pointer;
    }
  }
  // Its corners are rounded over this long.
  constexpr double kCorner_s = 0.1;
  constexpr double kRounded = 1.2;  // Factor by which the slack may be exceeded.
  const int half = std::max(1, static_cast<int>(std::lround(0.5 * kCorner_s * hz)));
  std::vector<double> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    double total = 0.0;
    for (int j = -half; j <= half; ++j) {
      const auto at = std::clamp<std::ptrdiff_t>(
          static_cast<std::ptrdiff_t>(k) + j, 0, static_cast<std::ptrdiff_t>(count) - 1);
      total += (half + 1 - std::abs(j)) * sum[static_cast<std::size_t>(at)];
    }
    // A corner of a fast turn is left sharp.
    const double slack = kRounded * slack_at(stance, yaws, k, options);
    out[k] = std::clamp(
        total / ((half + 1.0) * (half + 1.0)), yaws.rad[k] - slack, yaws.rad[k] + slack);
  }
  return out;
}

glm::dquat heading(double yaw_rad) {
  return glm::angleAxis(yaw_rad, kFootprintUp);
}

// Returns the pivot of the flat foot between ankle (0) and ball (1): the point that moves
// least.
double pivot_share(const FootprintStance& stance,
                   const std::vector<glm::dquat>& headings) {
  const auto flat = [&](std::size_t k) { return stance.flat(k); };
  const auto ankle = [&](std::size_t k) { return level(stance.place(k).ankle_in_world); };
  const auto to_ball = [&](std::size_t k) {
    return headings[k] * level(stance.foot.ball_from_ankle_in_t_pose);
  };
  const auto mean_ankle = mean(stance, flat, ankle);
  const auto mean_to_ball = mean(stance, flat, to_ball);
  if (!mean_ankle) return 1.0;
  // The ball unless its path is longer by more than this. [m]
  constexpr double kPathTolerance_m = 0.01;
  double both = 0.0;
  double own = 0.0;
  for (std::size_t k = 0; k < stance.count(); ++k) {
    if (!flat(k)) continue;
    const glm::dvec3 turned = to_ball(k) - *mean_to_ball;
    both +=
        kPathTolerance_m * kPathTolerance_m - glm::dot(ankle(k) - *mean_ankle, turned);
    own += kPathTolerance_m * kPathTolerance_m + glm::dot(turned, turned);
  }
  return std::clamp(both / own, 0.0, 1.0);
}

// Returns the path of the ankle from the first frame on: each turn is about the joint
// that bears.
std::vector<glm::dvec3> ways_of_ankle(const FootprintStance& stance,
                                      const std::vector<glm::dquat>& headings) {
  const double flat_share = pivot_share(stance, headings);
  const glm::dvec3 to_ball = level(stance.foot.ball_from_ankle_in_t_pose);
  std::vector<glm::dvec3> way(stance.count(), glm::dvec3(0.0));
  for (std::size_t k = 1; k < way.size(); ++k) {
    const bool heel = stance.on_heel(k - 1) && stance.on_heel(k);
    const bool ball = stance.on_ball(k - 1) && stance.on_ball(k);
    const double share = heel && ball ? flat_share : heel ? 0.0 : 1.0;
    way[k] = way[k - 1] + share * (headings[k - 1] * to_ball - headings[k] * to_ball);
  }
  return way;
}

}  // namespace

std::vector<Footprint> footprints(const StandingFootPath& path,
                                  const FrameRange& run,
                                  const FootMap& foot,
                                  FrameRate rate,
                                  const FootprintOptions& options) {
  MAREY_ASSERT(run.first >= 0 && run.last < static_cast<int>(path.reference.size()));
  const FootprintStance stance{path, run, foot};
  const std::size_t count = stance.count();
  const Yaws yaws = yaws_of(stance);
  const auto steady = steady_yaw(stance, yaws, options);
  const std::vector<double> turning =
      steady ? std::vector<double>(count, *steady)
             : following_yaws(stance, yaws, rate.hz, options);
  std::vector<glm::dquat> headings;
  for (const double yaw_rad : turning) headings.push_back(heading(yaw_rad));
  const std::vector<glm::dvec3> way =
      steady ? std::vector<glm::dvec3>(count) : ways_of_ankle(stance, headings);
  const auto flat_ball = [&](std::size_t k) {
    return headings[k] * foot.ball_from_ankle_in_t_pose;
  };
  const auto ankle = [&](std::size_t k) {
    return stance.place(k).ankle_in_world - way[k];
  };
  // The mean of its flat positions; for a stance on the ball or the heel alone, of that
  // joint's.
  auto start = mean(
      stance, [&](std::size_t k) { return stance.flat(k); }, ankle);
  if (!start) {
    start = mean(
        stance,
        [&](std::size_t k) { return stance.on_ball(k); },
        [&](std::size_t k) { return stance.ball(k) - flat_ball(k) - way[k]; });
  }
  if (!start)
    start = mean(
        stance, [](std::size_t) { return true; }, ankle);
  std::vector<Footprint> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    glm::dvec3 place = *start + way[k];
    place.y = foot.ankle_height_m;
    out[k] = {headings[k], place, place + flat_ball(k)};
  }
  return out;
}

}  // namespace marey::retarget
