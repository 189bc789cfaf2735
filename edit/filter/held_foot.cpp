// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/filter/held_foot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "edit/filter/smooth_runs.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/frame_range.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

using retarget::FootPlace;
/// A displacement that some frames prescribe.
using HeldShift = std::vector<std::optional<glm::dvec3>>;

constexpr double kHoldFade_s = 0.1;

/// Value and speed of a displacement at the edge of prescribed frames; time runs away
/// from them.
struct HeldEdge {
  glm::dvec3 value{0.0};
  glm::dvec3 speed{0.0};
};

/// Returns the value at an edge, and the slope of the line through the last 50 ms.
HeldEdge edge_at(const HeldShift& shift, std::size_t at, int step, double hz) {
  HeldEdge out{*shift[at], glm::dvec3(0.0)};
  constexpr double kLine_s = 0.05;
  const int most = std::max(2, static_cast<int>(std::lround(kLine_s * hz)));
  double tt = 0.0;
  glm::dvec3 tx(0.0);
  for (int k = 1; k <= most; ++k) {
    const auto frame = static_cast<std::ptrdiff_t>(at) - k * step;
    if (frame < 0 || frame >= static_cast<std::ptrdiff_t>(shift.size())) break;
    const auto& value = shift[static_cast<std::size_t>(frame)];
    if (!value) break;
    // The line goes through the edge's own value.
    tt += static_cast<double>(k) * k;
    tx += static_cast<double>(k) * (out.value - *value);
  }
  if (tt > 0.0) out.speed = tx * (hz / tt);
  return out;
}

/// Adds what remains of an edge's displacement after `since` frames.
glm::dvec3 faded(const HeldEdge& edge, double since, double fade, double hz) {
  const double left = 1.0 - since / fade;
  if (left <= 0.0) return glm::dvec3(0.0);
  return edge.value * smooth_step(left) +
         edge.speed * (left * left * left * since / hz);
}

/// Fills the frames between prescribed ones.
std::vector<glm::dvec3> filled(const HeldShift& shift, double hz) {
  const auto count = static_cast<int>(shift.size());
  std::vector<glm::dvec3> out(shift.size(), glm::dvec3(0.0));
  for (int t = 0; t < count; ++t) {
    const auto at = static_cast<std::size_t>(t);
    if (shift[at]) {
      out[at] = *shift[at];
      continue;
    }
    int last = t;
    while (last + 1 < count && !shift[static_cast<std::size_t>(last) + 1]) ++last;
    const double gap = last - t + 2;
    const double fade = std::min(kHoldFade_s * hz, gap);
    std::optional<HeldEdge> before;
    std::optional<HeldEdge> after;
    if (t > 0) before = edge_at(shift, at - 1, 1, hz);
    if (last + 1 < count) {
      after = edge_at(shift, static_cast<std::size_t>(last) + 1, -1, hz);
    }
    for (int k = t; k <= last; ++k) {
      glm::dvec3& value = out[static_cast<std::size_t>(k)];
      if (before) value += faded(*before, k - t + 1, fade, hz);
      if (after) value += faded(*after, last + 1 - k, fade, hz);
    }
    t = last;
  }
  return out;
}

/// Returns the share of the unfiltered path in each frame.
std::vector<double> impact_shares(std::span<const int> impacts,
                                  std::size_t count,
                                  double hz) {
  constexpr double kNear_s = 0.025;
  std::vector<double> out(count, 0.0);
  const int near = static_cast<int>(std::ceil(kNear_s * hz));
  for (const int impact : impacts) {
    const int first = std::max(impact - near, 0);
    const int last = std::min(impact + near, static_cast<int>(count) - 1);
    for (int t = first; t <= last; ++t) {
      double& share = out[static_cast<std::size_t>(t)];
      share = std::max(
          share, 1.0 - smooth_step(std::abs(t - impact) / (hz * kNear_s)));
    }
  }
  return out;
}

/// Returns the runs, which begin and end at impacts that are within 40 ms.
std::vector<FrameRange> to_impacts(std::vector<FrameRange> runs,
                                   std::span<const int> impacts,
                                   double hz) {
  constexpr double kReach_s = 0.04;
  const auto reach = static_cast<int>(std::lround(kReach_s * hz));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    FrameRange& run = runs[i];
    const int low = i == 0 ? 0 : runs[i - 1].last + 1;
    for (const int impact : impacts) {
      if (impact < run.first && impact >= run.first - reach && impact >= low) {
        run.first = impact;
      }
      const bool is_free = i + 1 == runs.size() || impact < runs[i + 1].first;
      if (impact > run.last && impact <= run.last + reach && is_free) run.last = impact;
    }
  }
  return runs;
}

/// The foot as it stood, smoothed within contacts.
struct StoodFoot {
  HeldShift ankle;                              ///< In contacts of the heel. World.
  HeldShift ball;                               ///< In contacts of the ball. World.
  std::vector<std::optional<glm::dquat>> foot;  ///< Only while the foot is flat.
  std::vector<std::optional<glm::dquat>> toes;  ///< In contacts of the ball.
  std::vector<FrameRange> flat;
};

std::vector<FrameRange> common_runs(const std::vector<FrameRange>& a,
                                    const std::vector<FrameRange>& b) {
  std::vector<FrameRange> out;
  for (const FrameRange& p : a) {
    for (const FrameRange& q : b) {
      const FrameRange both{std::max(p.first, q.first), std::min(p.last, q.last)};
      if (both.first <= both.last) out.push_back(both);
    }
  }
  return out;
}

VectorRun turns_in_run(std::span<const FootPlace> places,
                       glm::dquat FootPlace::*part,
                       const FrameRange& frames) {
  VectorRun out{frames, {}};
  const glm::dquat& first = places[static_cast<std::size_t>(frames.first)].*part;
  for (int t = frames.first; t <= frames.last; ++t) {
    out.values.push_back(rotation_vector(glm::conjugate(first) *
                                         (places[static_cast<std::size_t>(t)].*part)));
  }
  return out;
}

StoodFoot stood_foot(std::span<const FootPlace> before,
                     const FootContacts& contacts,
                     const retarget::FootMap& foot,
                     std::span<const int> impacts,
                     double hz) {
  std::vector<glm::dvec3> ankle;
  std::vector<glm::dvec3> ball;
  for (const FootPlace& place : before) {
    ankle.push_back(place.ankle_in_world);
    ball.push_back(place.ankle_in_world + place.foot * foot.ball_from_ankle_in_t_pose);
  }
  const auto heel_runs = to_impacts(contacts.heel, impacts, hz);
  const auto ball_runs = to_impacts(contacts.ball, impacts, hz);
  StoodFoot out{HeldShift(before.size()), HeldShift(before.size()), {}, {}, {}};
  out.foot.resize(before.size());
  out.toes.resize(before.size());
  out.flat = common_runs(heel_runs, ball_runs);
  std::vector<VectorRun> places;
  std::vector<VectorRun> turns;
  for (const FrameRange& run : heel_runs) {
    places.push_back(
        places_in_run(ankle, before[static_cast<std::size_t>(run.first)].foot, run));
  }
  for (const FrameRange& run : ball_runs) {
    places.push_back(
        places_in_run(ball, before[static_cast<std::size_t>(run.first)].foot, run));
    turns.push_back(turns_in_run(before, &FootPlace::toes, run));
  }
  for (const FrameRange& run : out.flat) {
    turns.push_back(turns_in_run(before, &FootPlace::foot, run));
  }
  constexpr double kMinNoise_m = 1e-4;
  constexpr double kMinNoise_rad = 5e-4;
  smooth_runs(places, kMinNoise_m, hz);
  smooth_runs(turns, kMinNoise_rad, hz);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool is_heel = i < heel_runs.size();
    const auto first = static_cast<std::size_t>(places[i].frames.first);
    for (std::size_t k = 0; k < places[i].values.size(); ++k) {
      const glm::dvec3 way = before[first].foot * places[i].values[k];
      (is_heel ? out.ankle : out.ball)[first + k] = (is_heel ? ankle : ball)[first] + way;
    }
  }
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const bool is_toes = i < ball_runs.size();
    const auto first = static_cast<std::size_t>(turns[i].frames.first);
    const glm::dquat& start = is_toes ? before[first].toes : before[first].foot;
    for (std::size_t k = 0; k < turns[i].values.size(); ++k) {
      (is_toes ? out.toes : out.foot)[first + k] =
          start * rotation_from_vector(turns[i].values[k]);
    }
  }
  return out;
}

/// Returns the turns from filtered to held rotations.
std::vector<glm::dvec3> held_turns(std::span<const FootPlace> before,
                                   std::span<const FootPlace> after,
                                   glm::dquat FootPlace::*part,
                                   const std::vector<std::optional<glm::dquat>>& stood,
                                   std::span<const double> raw_share,
                                   double hz) {
  HeldShift turn(before.size());
  for (std::size_t t = 0; t < before.size(); ++t) {
    const glm::dquat back = glm::conjugate(after[t].*part);
    if (stood[t]) turn[t] = rotation_vector(*stood[t] * back);
    if (raw_share[t] <= 0.0) continue;
    const glm::dvec3 raw = rotation_vector(before[t].*part * back);
    turn[t] = glm::mix(turn[t].value_or(glm::dvec3(0.0)), raw, raw_share[t]);
  }
  return filled(turn, hz);
}

}  // namespace

HeldFoot held_foot(std::span<const FootPlace> before,
                   std::span<const FootPlace> after,
                   const FootContacts& contacts,
                   const retarget::FootMap& foot,
                   std::span<const int> impacts,
                   double hz) {
  const std::size_t count = before.size();
  const std::vector<double> raw_share = impact_shares(impacts, count, hz);
  const StoodFoot stood = stood_foot(before, contacts, foot, impacts, hz);
  const auto foot_turns =
      held_turns(before, after, &FootPlace::foot, stood.foot, raw_share, hz);
  const auto toes_turns =
      held_turns(before, after, &FootPlace::toes, stood.toes, raw_share, hz);
  // From the ankle at the start of a flat contact to the toe joint at its end.
  std::vector<double> on_ball(count, 0.0);
  for (const FrameRange& run : stood.flat) {
    for (int t = run.first; t <= run.last; ++t) {
      on_ball[static_cast<std::size_t>(t)] =
          smooth_step((t - run.first + 1.0) / (run.last - run.first + 2.0));
    }
  }
  HeldFoot out(count);
  HeldShift shift(count);
  for (std::size_t t = 0; t < count; ++t) {
    out[t] =
        FootPlace{after[t].ankle_in_world,
                  glm::normalize(rotation_from_vector(foot_turns[t]) * after[t].foot),
                  glm::normalize(rotation_from_vector(toes_turns[t]) * after[t].toes)};
    const glm::dvec3& to_ball = foot.ball_from_ankle_in_t_pose;
    const glm::dvec3 raw_ball = before[t].ankle_in_world + before[t].foot * to_ball;
    std::optional<glm::dvec3> ankle;
    if (stood.ankle[t]) {
      ankle = glm::mix(*stood.ankle[t], before[t].ankle_in_world, raw_share[t]);
    }
    if (stood.ball[t]) {
      const glm::dvec3 by_ball =
          glm::mix(*stood.ball[t], raw_ball, raw_share[t]) - out[t]->foot * to_ball;
      ankle = ankle ? glm::mix(*ankle, by_ball, on_ball[t]) : by_ball;
    }
    if (ankle) {
      shift[t] = *ankle - after[t].ankle_in_world;
    } else if (raw_share[t] > 0.0) {
      shift[t] = raw_share[t] * (before[t].ankle_in_world - after[t].ankle_in_world);
    }
  }
  const auto shifts = filled(shift, hz);
  for (std::size_t t = 0; t < count; ++t) out[t]->ankle_in_world += shifts[t];
  return out;
}

}  // namespace marey::edit
