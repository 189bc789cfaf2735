// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/foot_edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

namespace marey::dynamics {
namespace {

constexpr double kLeaving_m = 0.025;   // Rise of the tip at take-off.
constexpr double kLeavingShare = 0.6;  // Share of the tip's maximum speed afterwards.
constexpr double kLeavingPeak_s = 0.04;
constexpr double kSpeedHalfSpan_s = 0.01;
constexpr double kHeelMeeting_m = 0.010;  // Above the lowest height, at landing.
constexpr double kTipMeeting_m = 0.015;
// The back of the heel, from the rear end of the sole, in lengths from there to the ball.
constexpr double kBackInHeel = 0.5;
constexpr double kBackUpInHeel = 0.35;
constexpr double kBefore_s = 0.15;
constexpr double kAfter_s = 0.20;
// Feet that bear together are at about one height.
constexpr double kOneFloor_m = 0.06;
// The other foot bears too if it leaves or meets the floor within this time.
constexpr double kTogether_s = 0.05;

using Heights = std::optional<double>;

bool has_soles(const BodyTrack& track) {
  return std::all_of(track.soles.begin(), track.soles.end(), [&](const auto& sole) {
    return !sole.tip_in_world.empty();
  });
}

double lowest_of(const SoleTrack& sole, std::size_t i) {
  return std::min(
      {sole.heel_in_world[i].y, sole.ball_in_world[i].y, sole.tip_in_world[i].y});
}

int frame_of(const BodyTrack& track, double frames) {
  const auto last = static_cast<double>(track.com_in_world.size()) - 1.0;
  return static_cast<int>(std::clamp(frames, 0.0, last));
}

/// A foot's crossing of its level.
struct Crossing {
  double time_s = 0.0;
  double floor_m = 0.0;  // Lowest height of its stance.
};

// Frame between `i` and `i + 1` at which a height reaches a level.
double crossing_frame(double here_m, double next_m, double level_m, int i) {
  return i + (level_m - here_m) / (next_m - here_m);
}

Heights min_of(const auto& height_at, int first, int last, int& frame) {
  Heights lowest;
  for (int i = first; i <= last; ++i) {
    const double here_m = height_at(i);
    if (lowest && here_m >= *lowest) continue;
    lowest = here_m;
    frame = i;
  }
  return lowest;
}

/// Height of one point over the frames.
class PointHeight {
 public:
  PointHeight(const std::vector<glm::dvec3>& p_in_world, double hz)
      : p_in_world_(&p_in_world), hz_(hz) {}

  [[nodiscard]] double at(int frame) const {
    return (*p_in_world_)[static_cast<std::size_t>(frame)].y;
  }
  // Between frames; the ends count beyond the track.
  [[nodiscard]] double between(double frame) const {
    const auto last = static_cast<double>(p_in_world_->size()) - 1.0;
    const double in = std::clamp(frame, 0.0, last);
    const int i = static_cast<int>(in);
    const int next = std::min(i + 1, static_cast<int>(last));
    return at(i) + (in - i) * (at(next) - at(i));
  }
  // Upwards, over 20 ms or one frame. [m/s]
  [[nodiscard]] double speed(double frame) const {
    const double half = std::max(0.5, kSpeedHalfSpan_s * hz_);
    return (between(frame + half) - between(frame - half)) * hz_ / (2.0 * half);
  }

 private:
  const std::vector<glm::dvec3>* p_in_world_;
  double hz_;
};

// Frame at which the point's speed passes a share of its maximum after `from`, at which
// it has left its place; not before `first`.
double speed_frame(const PointHeight& tip, int first, double from, double hz) {
  constexpr double kStep = 0.25;
  double peak = from;
  for (double x = from; x <= from + kLeavingPeak_s * hz; x += kStep) {
    if (tip.speed(x) > tip.speed(peak)) peak = x;
  }
  const double wanted = kLeavingShare * tip.speed(peak);
  double x = peak;
  while (x - kStep > first && tip.speed(x - kStep) >= wanted) x -= kStep;
  const double low = tip.speed(x - kStep);
  const double high = tip.speed(x);
  return high > low ? x - kStep * std::clamp((high - wanted) / (high - low), 0.0, 1.0)
                    : x;
}

std::optional<Crossing> leaves(const BodyTrack& track,
                               const SoleTrack& sole,
                               double scale,
                               double near_s,
                               double tolerance_s) {
  const double hz = track.rate.hz;
  const PointHeight tip(sole.tip_in_world, hz);
  const auto tip_m = [&](int i) { return tip.at(i); };
  const int from = frame_of(track, std::floor((near_s - kBefore_s - tolerance_s) * hz));
  const int to = frame_of(track, std::ceil((near_s + 2.0 * tolerance_s) * hz));
  int at = from;
  const Heights lowest = min_of(tip_m, from, to, at);
  if (!lowest) return std::nullopt;
  const double level_m = *lowest + scale * kLeaving_m;
  for (int i = at; i < to; ++i) {
    if (tip_m(i + 1) < level_m) continue;
    const double time_s = speed_frame(tip, at, i, hz) / hz;
    if (std::abs(time_s - near_s) > tolerance_s) return std::nullopt;
    return Crossing{time_s, *lowest};
  }
  return std::nullopt;
}

// Height of the back of the heel.
double back_m(const SoleTrack& sole, int frame) {
  const auto i = static_cast<std::size_t>(frame);
  const glm::dvec3 along = sole.heel_in_world[i] - sole.ball_in_world[i];
  const double length_m = glm::length(along);
  const double up = length_m > 0.0 ? std::hypot(along.x, along.z) / length_m : 0.0;
  return sole.heel_in_world[i].y + kBackInHeel * along.y + kBackUpInHeel * length_m * up;
}

std::optional<Crossing> meets(const BodyTrack& track,
                              const SoleTrack& sole,
                              double scale,
                              double near_s,
                              double tolerance_s) {
  const double hz = track.rate.hz;
  const int from = frame_of(track, std::floor((near_s - tolerance_s) * hz));
  const int to = frame_of(track, std::ceil((near_s + kAfter_s) * hz));
  std::optional<Crossing> first;
  const auto comes_down = [&](const auto& height_m, double above_m) {
    int at = from;
    const Heights lowest = min_of(height_m, from, to, at);
    const double level_m = *lowest + above_m;
    for (int i = at; i > from; --i) {
      if (height_m(i - 1) < level_m) continue;
      const double time_s =
          crossing_frame(height_m(i - 1), height_m(i), level_m, i - 1) / hz;
      if (std::abs(time_s - near_s) <= tolerance_s &&
          (!first || time_s < first->time_s)) {
        first = Crossing{time_s, lowest_of(sole, static_cast<std::size_t>(at))};
      }
      return;
    }
  };
  comes_down([&](int i) { return back_m(sole, i); }, scale * kHeelMeeting_m);
  comes_down([&](int i) { return sole.tip_in_world[static_cast<std::size_t>(i)].y; },
             scale * kTipMeeting_m);
  return first;
}

using Crossings = std::array<std::optional<Crossing>, 2>;

// Leaves out a foot that is in the air: it passes its level far above the other's.
void drop_high_foot(double scale, Crossings& feet) {
  if (!feet[0] || !feet[1]) return;
  const double higher_m = feet[0]->floor_m - feet[1]->floor_m;
  if (std::abs(higher_m) > kOneFloor_m * scale) feet[higher_m > 0.0 ? 0 : 1].reset();
}

std::optional<FootEdge> edge_of(const Crossings& feet, bool is_last) {
  std::optional<FootEdge> edge;
  for (const auto& foot : feet) {
    if (!foot) continue;
    if (!edge || (foot->time_s > edge->time_s) == is_last) edge = {foot->time_s, {}};
  }
  if (!edge) return edge;
  for (std::size_t side = 0; side < 2; ++side) {
    edge->bears[side] =
        feet[side] && std::abs(feet[side]->time_s - edge->time_s) <= kTogether_s;
  }
  return edge;
}

/// Time around which an edge is searched, and the size of the feet.
struct EdgeSearch {
  double scale = 1.0;
  double near_s = 0.0;
  double tolerance_s = 0.0;
};

/// Returns the edge of both feet by the rule of one foot: leaves() or meets().
template <class Rule>
std::optional<FootEdge> edge_by(const Rule& rule,
                                bool is_takeoff,
                                const BodyTrack& track,
                                const EdgeSearch& search) {
  if (!has_soles(track)) return std::nullopt;
  Crossings feet;
  for (std::size_t side = 0; side < 2; ++side) {
    feet[side] =
        rule(track, track.soles[side], search.scale, search.near_s, search.tolerance_s);
  }
  drop_high_foot(search.scale, feet);
  return edge_of(feet, is_takeoff);
}

}  // namespace

double foot_scale(const BodyTrack& track) {
  double sum_m = 0.0;
  int count = 0;
  for (const SoleTrack& sole : track.soles) {
    for (std::size_t i = 0; i < sole.tip_in_world.size(); ++i) {
      sum_m += glm::distance(sole.heel_in_world[i], sole.ball_in_world[i]) +
               glm::distance(sole.ball_in_world[i], sole.tip_in_world[i]);
      ++count;
    }
  }
  return count > 0 && sum_m > 0.0 ? sum_m / count / kAdultFoot_m : 1.0;
}

std::optional<FootEdge> foot_takeoff(const BodyTrack& track,
                                     double scale,
                                     double near_s,
                                     double tolerance_s) {
  return edge_by(leaves, true, track, {scale, near_s, tolerance_s});
}

std::optional<FootEdge> foot_landing(const BodyTrack& track,
                                     double scale,
                                     double near_s,
                                     double tolerance_s) {
  return edge_by(meets, false, track, {scale, near_s, tolerance_s});
}

double lowest_sole_m(const BodyTrack& track, std::size_t frame) {
  return std::min(lowest_of(track.soles[0], frame), lowest_of(track.soles[1], frame));
}

glm::dvec3 standing_place(const BodyTrack& track,
                          const std::array<bool, 2>& bears,
                          double from_s,
                          double to_s) {
  const int first = frame_of(track, std::ceil(from_s * track.rate.hz));
  const int last = std::max(first, frame_of(track, std::floor(to_s * track.rate.hz)));
  const bool any = bears[0] || bears[1];
  glm::dvec3 sum(0.0);
  double floor_m = 0.0;
  int feet = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    if (any && !bears[side]) continue;
    const SoleTrack& sole = track.soles[side];
    const auto highest_m = [&](int frame) {
      const auto i = static_cast<std::size_t>(frame);
      return std::max(
          {sole.heel_in_world[i].y, sole.ball_in_world[i].y, sole.tip_in_world[i].y});
    };
    int at = first;
    (void)min_of(highest_m, first, last, at);
    const auto i = static_cast<std::size_t>(at);
    sum += 0.5 * (sole.heel_in_world[i] + sole.tip_in_world[i]);
    const double low_m = lowest_of(sole, i);
    floor_m = feet == 0 ? low_m : std::min(floor_m, low_m);
    ++feet;
  }
  sum /= static_cast<double>(feet);
  return {sum.x, floor_m, sum.z};
}

}  // namespace marey::dynamics
