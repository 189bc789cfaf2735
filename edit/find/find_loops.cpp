// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/find_loops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

#include "edit/find/loop_cost.h"

#include "core/base/assert.h"
#include "core/base/format_text.h"

namespace marey::edit {
namespace {

constexpr double kBelowPeriod = 0.75;
constexpr double kAbovePeriod = 1.25;
constexpr double kFullTurn = 6.283185307179586477;
constexpr double kFarPair = std::numeric_limits<double>::infinity();
constexpr int kMaxMapFrames = 2400;
constexpr double kMaxLoopPairs = 2e9;
/// Pairs that are compared by all joints, per candidate that is returned.
constexpr int kRefinedPerCandidate = 3;

FrameRange range_within(const EditState& state, const FindLoopsOptions& options) {
  return options.within.value_or(FrameRange{0, state.frame_count() - 1});
}

/// Returns the strikes and other good pairs, far enough from each other.
std::vector<LoopPair> best_pairs(GoodPairs pairs, int min_apart, int max_count) {
  std::vector<LoopPair> out = std::move(pairs.strikes);
  max_count += static_cast<int>(out.size());
  for (const LoopPair& pair : pairs.minima) {
    if (static_cast<int>(out.size()) >= max_count) break;
    const bool is_near = std::any_of(out.begin(), out.end(), [&](const LoopPair& taken) {
      return std::abs(taken.first - pair.first) < min_apart &&
             std::abs(taken.last - pair.last) < min_apart;
    });
    if (!is_near) out.push_back(pair);
  }
  return out;
}

LoopCandidate candidate(const MatchPoints& points,
                        int first,
                        int last,
                        const MatchOptions& options) {
  LoopCandidate out;
  out.first = first;
  out.last = last;
  out.period_frames = last - first;
  out.match = match_windows(points, last, points, first, options);
  out.travel = out.match.a_from_b;
  if (last + 1 >= points.frame_count() || last - 1 <= first) return out;
  const PlanarMatch before = match_windows(points, last - 1, points, first, options);
  const PlanarMatch after = match_windows(points, last + 1, points, first, options);
  const auto squared = [](const PlanarMatch& m) { return m.distance_m * m.distance_m; };
  const double bend = squared(before) - 2.0 * squared(out.match) + squared(after);
  if (bend <= 0.0) return out;
  const double off =
      std::clamp(0.5 * (squared(before) - squared(after)) / bend, -0.5, 0.5);
  out.period_frames += off;
  const PlanarMove& next = off < 0.0 ? before.a_from_b : after.a_from_b;
  const double turn = std::remainder(next.turn_rad - out.travel.turn_rad, kFullTurn);
  out.travel.turn_rad += std::abs(off) * turn;
  out.travel.shift_xz_m += std::abs(off) * (next.shift_xz_m - out.travel.shift_xz_m);
  return out;
}

double rank(const LoopCandidate& loop, const FindLoopsOptions& options) {
  const double preference =
      loop.edge == LoopEdge::kNone ? std::max(1.0, options.strike_preference) : 1.0;
  return loop.match.distance_m * preference;
}

}  // namespace

std::optional<LoopPeriods> loop_periods(const EditState& state,
                                        const FindLoopsOptions& options) {
  const FrameRange within = range_within(state, options);
  MAREY_ASSERT(within.first >= 0 && within.last < state.frame_count());
  if (within.last <= within.first) return std::nullopt;
  const double hz = state.motion.rate.hz;
  LoopPeriods out;
  double min_s = options.min_period_s.value_or(0.0);
  double max_s = options.max_period_s.value_or(state.duration_s());
  if (!options.min_period_s || !options.max_period_s) {
    out.feet = foot_period(state.motion, state.map, within);
    if (!out.feet && !options.min_period_s && !options.max_period_s) return std::nullopt;
    if (out.feet && !options.min_period_s) min_s = kBelowPeriod * out.feet->period_s;
    if (out.feet && !options.max_period_s) max_s = kAbovePeriod * out.feet->period_s;
  }
  out.min_frames = std::max(2, static_cast<int>(std::ceil(min_s * hz - 1e-9)));
  out.max_frames = std::min(within.last - within.first,
                            static_cast<int>(std::floor(max_s * hz + 1e-9)));
  if (out.max_frames < out.min_frames) return std::nullopt;
  return out;
}

Status check_loop_search(const EditState& state, const FindLoopsOptions& options) {
  const auto periods = loop_periods(state, options);
  if (!periods) return Done{};
  const FrameRange within = range_within(state, options);
  const double frames = within.last - within.first + 1;
  const double pairs = frames * (periods->max_frames - periods->min_frames + 1);
  if (pairs <= kMaxLoopPairs) return Done{};
  return bad_input("motion",
                   format_text("the search for a cycle of %.3f to %.3f s would compare "
                               "%.0f million pairs of frames, more than %.0f million",
                               periods->min_frames / state.motion.rate.hz,
                               periods->max_frames / state.motion.rate.hz,
                               1e-6 * pairs,
                               1e-6 * kMaxLoopPairs),
                   "give min_period_s and max_period_s that are closer to each other, or "
                   "a shorter span");
}

std::vector<LoopCandidate> find_loops(const EditState& state,
                                      const FindLoopsOptions& options) {
  const auto periods = loop_periods(state, options);
  if (!periods) return {};
  const FrameRange within = range_within(state, options);
  const SupportMarks marks = support_marks(state);
  const int min_apart = std::max(
      1, static_cast<int>(std::lround(options.min_apart_s * state.motion.rate.hz)));
  GoodPairs good = good_pairs(state, within, *periods, marks, options.match);
  const auto max_pairs =
      static_cast<std::size_t>(kRefinedPerCandidate * options.max_candidates);
  if (good.strikes.size() > max_pairs) good.strikes.resize(max_pairs);
  const std::vector<LoopPair> pairs =
      best_pairs(std::move(good), min_apart, static_cast<int>(max_pairs));
  const MatchPoints points = match_points(state.motion, state.map);
  std::vector<LoopCandidate> out;
  for (const LoopPair& pair : pairs) {
    out.push_back(candidate(points, pair.first, pair.last, options.match));
    out.back().edge = common_edge(marks, pair.first, pair.last);
  }
  std::stable_sort(
      out.begin(), out.end(), [&](const LoopCandidate& a, const LoopCandidate& b) {
        return rank(a, options) < rank(b, options);
      });
  if (static_cast<int>(out.size()) > options.max_candidates) {
    out.resize(static_cast<std::size_t>(options.max_candidates));
  }
  return out;
}

LoopCandidate compare_loop(const EditState& state,
                           int first,
                           int last,
                           const MatchOptions& options) {
  MAREY_ASSERT(first >= 0 && first < last && last < state.frame_count());
  const MatchPoints points = match_points(state.motion, state.map);
  LoopCandidate out = candidate(points, first, last, options);
  out.edge = common_edge(support_marks(state), first, last);
  return out;
}

LoopMap loop_map(const EditState& state, int max_cells, const MatchOptions& options) {
  MAREY_ASSERT(max_cells >= 1);
  const int stride =
      std::max(1, (state.frame_count() + kMaxMapFrames - 1) / kMaxMapFrames);
  LoopCost cost(state.motion, state.map, options, stride);
  const int count = cost.frame_count();
  const int per_cell = std::max(1, (count + max_cells - 1) / max_cells);
  LoopMap out;
  out.cells = (count + per_cell - 1) / per_cell;
  out.cell_frames = per_cell * stride;
  const auto cells = static_cast<std::size_t>(out.cells);
  std::vector<double> squared(cells * cells, kFarPair);
  std::vector<double> row;
  for (int lag = 0; lag < count; ++lag) {
    row.resize(static_cast<std::size_t>(count - lag));
    cost.squared_distances(lag, row);
    for (int k = 0; k < count - lag; ++k) {
      double& cell = squared[static_cast<std::size_t>(k / per_cell) * cells +
                             static_cast<std::size_t>((k + lag) / per_cell)];
      cell = std::min(cell, row[static_cast<std::size_t>(k)]);
    }
  }
  out.distance_m.reserve(squared.size());
  for (const double value : squared) {
    out.distance_m.push_back(value == kFarPair ? 0.0F
                                               : static_cast<float>(std::sqrt(value)));
  }
  return out;
}

}  // namespace marey::edit
