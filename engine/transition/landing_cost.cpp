// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/transition/landing_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/clips/sample_clip.h"
#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

constexpr double kEntryStep_s = 1.0 / 60.0;
constexpr double kDelayStep_s = 0.04;
constexpr std::size_t kMaxEntries = 240;
constexpr double kSoon_s = 0.1;
constexpr double kSlope_s = 0.004;
constexpr double kFreeShare = 0.3;
constexpr double kMovesOn_s = 0.1;
constexpr double kOppositeCost_m_s = 1.0;
constexpr double kDelayCost_m_s = 0.1;
constexpr double kShiftCost_m_s = 0.02;
constexpr int kOppositeSamples = 6;

std::array<glm::dvec3, 2> ankles_m(const Rig& rig,
                                   const MotionClip& clip,
                                   double source_s) {
  BlendPosture posture;
  sample_clip(clip, source_s, posture);
  std::array<glm::dvec3, 2> out = foot_places(rig, posture).ankle;
  for (glm::dvec3& ankle : out) {
    ankle.y += static_cast<double>(posture.height_legs);
    ankle *= rig.leg_length_m;
  }
  return out;
}

std::array<bool, 2> feet_of(unsigned bits) {
  return {(bits & 3U) != 0U, (bits & 12U) != 0U};
}

bool are_opposite(const std::array<bool, 2>& a, const std::array<bool, 2>& b) {
  return (a[0] || a[1]) && (b[0] || b[1]) && !(a[0] && b[0]) && !(a[1] && b[1]);
}

}  // namespace

ClipFeet clip_feet(const Rig& rig, const MotionClip& clip, double source_s, double rate) {
  ClipFeet out;
  out.ankle_m = ankles_m(rig, clip, source_s);
  const double later_s = source_s + kSlope_s;
  const auto later = ankles_m(rig, clip, later_s);
  const RootPlace moves = relative(path_at(clip, source_s), path_at(clip, later_s));
  const double c = std::cos(moves.heading_rad);
  const double s = std::sin(moves.heading_rad);
  for (std::size_t side = 0; side < 2; ++side) {
    const glm::dvec3& p = later[side];
    const glm::dvec3 at(rig.leg_length_m * moves.x_m + c * p.x + s * p.z,
                        p.y,
                        rig.leg_length_m * moves.z_m + c * p.z - s * p.x);
    out.velocity_m_s[side] = (at - out.ankle_m[side]) * (rate / kSlope_s);
  }
  const unsigned now = bearing_at(clip, source_s);
  out.bears_now = feet_of(now);
  out.bears = feet_of(now | bearing_at(clip, source_s + 0.5 * kSoon_s * rate) |
                      bearing_at(clip, source_s + kSoon_s * rate));
  return out;
}

double landing_cost(const ClipFeet& from, const ClipFeet& to) {
  double cost_m = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const double apart_m = glm::length(from.ankle_m[side] - to.ankle_m[side]);
    if (!to.bears[side]) {
      cost_m += kFreeShare * apart_m;
      continue;
    }
    cost_m += apart_m;
    if (!from.bears_now[side]) {
      cost_m += kMovesOn_s * glm::length(from.velocity_m_s[side]);
    }
  }
  return cost_m;
}

double entry_landing_cost(const EntryQuestion& question,
                          double delay_s,
                          double to_source_s) {
  const double middle_s = delay_s + 0.5 * question.fade_s;
  const ClipFeet from = clip_feet(*question.rig,
                                  *question.from,
                                  question.from_source_s + middle_s * question.from_rate,
                                  question.from_rate);
  const ClipFeet to =
      clip_feet(*question.rig, *question.to, to_source_s, question.to_rate);
  double cost_m = landing_cost(from, to);
  for (int i = 0; i < kOppositeSamples; ++i) {
    const double after_s = ((i + 0.5) / kOppositeSamples - 0.5) * question.fade_s;
    const unsigned a =
        bearing_at(*question.from,
                   question.from_source_s + (middle_s + after_s) * question.from_rate);
    const unsigned b = bearing_at(*question.to, to_source_s + after_s * question.to_rate);
    if (!are_opposite(feet_of(a), feet_of(b))) continue;
    cost_m += kOppositeCost_m_s * question.fade_s / kOppositeSamples;
  }
  return cost_m;
}

EntryAnswer choose_entry(const EntryQuestion& question) {
  double first_s = question.first_s;
  double last_s = question.last_s;
  if (question.anywhere) {
    first_s = question.asked_s;
    last_s = question.asked_s + question.to->duration_s();
  }
  const double length_s = std::max(0.0, last_s - first_s);
  const std::size_t count = std::min(
      kMaxEntries, static_cast<std::size_t>(std::ceil(length_s / kEntryStep_s)) + 1);
  EntryAnswer best{question.asked_s, 0.0, std::numeric_limits<double>::infinity()};
  const int delays = static_cast<int>(question.max_delay_s / kDelayStep_s + 1e-9);
  for (int d = 0; d <= delays; ++d) {
    const double delay_s = d * kDelayStep_s;
    const double middle_s = delay_s + 0.5 * question.fade_s;
    for (std::size_t i = 0; i < count; ++i) {
      const double share =
          count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
      const double entry_s = first_s + share * length_s;
      double shift_s = entry_s - question.asked_s;
      if (question.anywhere) shift_s = std::remainder(shift_s, question.to->duration_s());
      const double cost_m =
          entry_landing_cost(question, delay_s, entry_s + middle_s * question.to_rate) +
          kDelayCost_m_s * delay_s + kShiftCost_m_s * std::abs(shift_s);
      if (cost_m < best.cost_m) best = {entry_s, delay_s, cost_m};
    }
  }
  return best;
}

}  // namespace marey::engine
