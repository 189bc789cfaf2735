// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "edit/find/find_splice.h"
#include <glm/common.hpp>

#include "core/base/assert.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

// Edges of contacts further apart than this belong to different steps. [s]
constexpr double kSameStep_s = 0.12;
constexpr double kMinRate = 0.5;
constexpr double kMaxRate = 2.0;
// Room between edges and to the ends of the overlap. [frames]
constexpr double kMinRoom = 2.0;

// One instant of the result and of both motions, in frames since the overlap's start.
struct SpliceKnot {
  double at = 0.0;
  double first = 0.0;
  double second = 0.0;
};

// Edges of one kind of one foot, in frames since the overlap's start.
std::vector<double> contact_edges(const std::vector<FrameRange>& stances,
                                  bool is_start,
                                  int overlap_start,
                                  int length) {
  std::vector<double> out;
  for (const FrameRange& stance : stances) {
    const double edge = is_start ? stance.first - 0.5 : stance.last + 0.5;
    const double since = edge - overlap_start;
    if (since > kMinRoom && since < length - kMinRoom) out.push_back(since);
  }
  return out;
}

bool is_allowed_rate(double change, double time) {
  return time > 0.0 && change >= kMinRate * time && change <= kMaxRate * time;
}

// Inserts a knot unless a rate next to it would leave the limits.
bool insert_knot(const SpliceKnot& knot, std::vector<SpliceKnot>& knots) {
  const auto after = std::find_if(
      knots.begin(), knots.end(), [&](const SpliceKnot& k) { return k.at >= knot.at; });
  if (after == knots.begin() || after == knots.end()) return false;
  const auto fits = [](const SpliceKnot& a, const SpliceKnot& b) {
    const double time = b.at - a.at;
    return time >= kMinRoom && is_allowed_rate(b.first - a.first, time) &&
           is_allowed_rate(b.second - a.second, time);
  };
  if (!fits(*(after - 1), knot) || !fits(knot, *after)) return false;
  knots.insert(after, knot);
  return true;
}

// Pairs of edges of the same foot and kind, nearest first.
std::vector<std::array<double, 2>> paired_edges(const EditState& first,
                                                int first_start,
                                                const EditState& second,
                                                int second_start,
                                                int length) {
  const double reach = kSameStep_s * first.motion.rate.hz;
  std::vector<std::array<double, 2>> pairs;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const bool is_start : {true, false}) {
      const auto a =
          contact_edges(first.contacts.feet[side].stance, is_start, first_start, length);
      const auto b = contact_edges(
          second.contacts.feet[side].stance, is_start, second_start, length);
      for (const double x : a) {
        for (const double y : b) {
          if (std::abs(x - y) <= reach) pairs.push_back({x, y});
        }
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& p, const auto& q) {
    return std::abs(p[0] - p[1]) < std::abs(q[0] - q[1]);
  });
  return pairs;
}

double splice_weight(double at, int length) {
  return smooth_step(at / length);
}

// Value of a quintic between two knots with second derivatives 0. `slope` is per span. It
// is monotone if both slopes are at most 2.14 of the mean slope.
double warp_between(
    double from, double to, double slope_from, double slope_to, double x) {
  const double x3 = x * x * x;
  const double x4 = x3 * x;
  const double x5 = x4 * x;
  return from + slope_from * (x - 6.0 * x3 + 8.0 * x4 - 3.0 * x5) +
         slope_to * (-4.0 * x3 + 7.0 * x4 - 3.0 * x5) +
         (to - from) * (10.0 * x3 - 15.0 * x4 + 6.0 * x5);
}

// Evaluates one motion's warp at the whole frames of the result. core/time_warp.h has the
// same intervals, but its speed at the ends is not 1.
std::vector<double> warp_frames(const std::vector<SpliceKnot>& knots,
                                double SpliceKnot::*value,
                                int length) {
  const std::size_t spans = knots.size() - 1;
  std::vector<double> rate(spans);
  for (std::size_t k = 0; k < spans; ++k) {
    rate[k] = (knots[k + 1].*value - knots[k].*value) / (knots[k + 1].at - knots[k].at);
  }
  // Slopes: 1 at both ends, harmonic means within.
  std::vector<double> slope(knots.size(), 1.0);
  for (std::size_t k = 1; k < spans; ++k) {
    slope[k] = 2.0 * rate[k - 1] * rate[k] / (rate[k - 1] + rate[k]);
  }
  std::vector<double> out;
  std::size_t span = 0;
  for (int frame = 0; frame <= length; ++frame) {
    while (span + 1 < spans && frame > knots[span + 1].at) ++span;
    const SpliceKnot& a = knots[span];
    const SpliceKnot& b = knots[span + 1];
    const double h = b.at - a.at;
    out.push_back(warp_between(
        a.*value, b.*value, slope[span] * h, slope[span + 1] * h, (frame - a.at) / h));
  }
  out.front() = 0.0;
  out.back() = length;
  return out;
}

// Warps the frames in which root and legs are mixed. The starts are those of the body.
void warp_to_supports(const EditState& first,
                      int first_start,
                      const EditState& second,
                      int second_start,
                      SpliceOverlap& overlap) {
  const int length = overlap.body_frames();
  std::vector<SpliceKnot> knots{{}, {1.0 * length, 1.0 * length, 1.0 * length}};
  bool is_plain = true;
  for (const auto& [x, y] :
       paired_edges(first, first_start, second, second_start, length)) {
    const double at = glm::mix(x, y, splice_weight(0.5 * (x + y), length));
    if (!insert_knot({at, x, y}, knots)) continue;
    ++overlap.matched_edges;
    is_plain = is_plain && x == y;
  }
  if (is_plain) return;
  const auto first_at = warp_frames(knots, &SpliceKnot::first, length);
  const auto second_at = warp_frames(knots, &SpliceKnot::second, length);
  for (std::size_t k = 0; k < first_at.size(); ++k) {
    const double frame = static_cast<double>(k);
    const std::size_t entry = static_cast<std::size_t>(overlap.body.first) + k;
    overlap.first_at[entry] = first_start + first_at[k];
    overlap.second_at[entry] = second_start + second_at[k];
    const double warp =
        std::max(std::abs(first_at[k] - frame), std::abs(second_at[k] - frame));
    overlap.max_warp_s = std::max(overlap.max_warp_s, warp / first.motion.rate.hz);
  }
}

void measure_opposed(const EditState& first,
                     const EditState& second,
                     SpliceOverlap& overlap) {
  const auto end = static_cast<std::size_t>(overlap.body.last);
  for (auto k = static_cast<std::size_t>(overlap.body.first); k <= end; ++k) {
    const auto frame_of = [&](double at) { return static_cast<int>(std::lround(at)); };
    if (supports_oppose(support_class(first.contacts, frame_of(overlap.first_at[k])),
                        support_class(second.contacts, frame_of(overlap.second_at[k])))) {
      overlap.opposed_s += 1.0 / first.motion.rate.hz;
    }
  }
}

// Frames before and after the pair that an overlap of this length has.
struct OverlapSides {
  int before = 0;
  int after = 0;
};

OverlapSides sides_of(int frames, const OverlapSides& room) {
  OverlapSides out;
  out.before = std::min(frames / 2, room.before);
  out.after = std::min(frames - out.before, room.after);
  out.before = std::min(frames - out.after, room.before);
  return out;
}

}  // namespace

SpliceOverlap plan_splice_overlap(const EditState& first,
                                  int leave,
                                  const EditState& second,
                                  int enter,
                                  const SpliceOverlapOptions& options) {
  MAREY_ASSERT(leave >= 0 && leave < first.frame_count());
  MAREY_ASSERT(enter >= 0 && enter < second.frame_count() && options.frames >= 0);
  const OverlapSides room{
      std::min(leave, enter),
      std::min(first.frame_count() - 1 - leave, second.frame_count() - 1 - enter)};
  const OverlapSides body = sides_of(options.frames, room);
  OverlapSides upper = sides_of(std::max(options.frames, options.upper_frames), room);
  upper = {std::max(upper.before, body.before), std::max(upper.after, body.after)};
  const int length = body.before + body.after;
  const int upper_length = upper.before + upper.after;
  SpliceOverlap overlap;
  overlap.body.first = upper.before - body.before;
  overlap.body.last = overlap.body.first + length;
  for (int k = 0; k <= upper_length; ++k) {
    overlap.first_at.push_back(leave - upper.before + k);
    overlap.second_at.push_back(enter - upper.before + k);
    overlap.weight.push_back(length == 0 ? 0.0
                                         : splice_weight(k - overlap.body.first, length));
    overlap.upper_weight.push_back(upper_length == 0 ? 0.0
                                                     : splice_weight(k, upper_length));
  }
  if (options.align_supports && length > 0) {
    warp_to_supports(first, leave - body.before, second, enter - body.before, overlap);
  }
  measure_opposed(first, second, overlap);
  return overlap;
}

}  // namespace marey::edit
