// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/find_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include "edit/find/loop_cost.h"

#include "core/base/assert.h"
#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

constexpr double kBelowPeriod = 0.75;
constexpr double kAbovePeriod = 1.25;
constexpr double kStrikeTolerance_s = 0.02;
constexpr double kFullTurn = 6.283185307179586477;
constexpr double kFarPair = std::numeric_limits<double>::infinity();
/// A cycle in which the feet move less than this share of their usual movement is a rest
/// between cycles.
constexpr double kMinMovement = 0.5;
constexpr int kMaxMapFrames = 2400;
/// Pairs that are compared by all joints, per candidate that is returned.
constexpr int kRefinedPerCandidate = 3;

struct LoopPair {
  double squared = kFarPair;
  int first = 0;
  int last = 0;
};

bool is_better(const LoopPair& a, const LoopPair& b) {
  return std::tie(a.squared, a.first, a.last) < std::tie(b.squared, b.first, b.last);
}

FrameRange range_within(const EditState& state, const FindLoopsOptions& options) {
  return options.within.value_or(FrameRange{0, state.frame_count() - 1});
}

int strike_reach(const EditState& state) {
  return std::max(
      1, static_cast<int>(std::lround(kStrikeTolerance_s * state.motion.rate.hz)));
}

/// Feet on the floor, and the edge, of each frame.
struct SupportMarks {
  std::vector<int> feet;  ///< 1: left, 2: right, 3: both.
  std::vector<LoopEdge> edge;
};

SupportMarks support_marks(const EditState& state) {
  const auto count = static_cast<std::size_t>(state.frame_count());
  SupportMarks out{std::vector<int>(count, 0),
                   std::vector<LoopEdge>(count, LoopEdge::kNone)};
  const int reach = std::max(
      1, static_cast<int>(std::lround(kStrikeTolerance_s * state.motion.rate.hz)));
  // Left last: where both strike, the left foot decides.
  for (const std::size_t side : {std::size_t{1}, std::size_t{0}}) {
    const auto& stance = state.contacts.feet[side].stance;
    const std::vector<char> stands = retarget::frame_marks(stance, count);
    for (std::size_t t = 0; t < count; ++t) {
      if (stands[t]) out.feet[t] |= side == 0 ? 1 : 2;
    }
    for (const FrameRange& run : stance) {
      if (run.first == 0) continue;
      const int end = std::min(run.first + reach, state.frame_count() - 1);
      for (int t = std::max(0, run.first - reach); t <= end; ++t) {
        out.edge[static_cast<std::size_t>(t)] =
            side == 0 ? LoopEdge::kLeftStrike : LoopEdge::kRightStrike;
      }
    }
  }
  return out;
}

LoopEdge common_edge(const SupportMarks& marks, int first, int last) {
  const LoopEdge edge = marks.edge[static_cast<std::size_t>(first)];
  return edge == marks.edge[static_cast<std::size_t>(last)] ? edge : LoopEdge::kNone;
}

bool has_same_support(const SupportMarks& marks, int first, int last) {
  return marks.feet[static_cast<std::size_t>(first)] ==
             marks.feet[static_cast<std::size_t>(last)] ||
         common_edge(marks, first, last) != LoopEdge::kNone;
}

/// Deviation of the ankles' heights over any part of the motion, in constant time.
class LoopMovement {
 public:
  explicit LoopMovement(const EditState& state) {
    const auto heights =
        ankle_heights(state.motion, state.map, {0, state.frame_count() - 1});
    for (std::size_t side = 0; side < 2; ++side) {
      sum_[side].push_back(0.0);
      square_[side].push_back(0.0);
      for (const double height : heights[side]) {
        const double h = height - heights[side].front();
        sum_[side].push_back(sum_[side].back() + h);
        square_[side].push_back(square_[side].back() + h * h);
      }
    }
  }
  /// From `first` to `last`, the latter excluded.
  [[nodiscard]] double deviation_m(int first, int last) const {
    const auto a = static_cast<std::size_t>(first);
    const auto b = static_cast<std::size_t>(last);
    double variance = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
      const double mean = (sum_[side][b] - sum_[side][a]) / (last - first);
      variance += (square_[side][b] - square_[side][a]) / (last - first) - mean * mean;
    }
    return std::sqrt(std::max(0.0, 0.5 * variance));
  }

 private:
  std::array<std::vector<double>, 2> sum_;
  std::array<std::vector<double>, 2> square_;
};

/// Squared distances of all pairs in the range; those with other supports are far.
struct PairTable {
  int min_lag = 0;
  int first_frame = 0;
  std::vector<std::vector<double>> by_lag;  ///< [lag - min_lag][first - first_frame].

  [[nodiscard]] double at(int lag, int k) const {
    if (lag < 0 || lag >= static_cast<int>(by_lag.size())) return kFarPair;
    const auto& row = by_lag[static_cast<std::size_t>(lag)];
    return k < 0 || k >= static_cast<int>(row.size()) ? kFarPair
                                                      : row[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] bool is_local_minimum(int lag, int k) const {
    const double here = at(lag, k);
    if (here == kFarPair) return false;
    for (int other = lag - 1; other <= lag + 1; ++other) {
      for (int next = k - 1; next <= k + 1; ++next) {
        if (at(other, next) < here) return false;
      }
    }
    return true;
  }
};

PairTable pair_table(const EditState& state,
                     const FindLoopsOptions& options,
                     const LoopPeriods& periods,
                     const SupportMarks& marks) {
  const FrameRange within = range_within(state, options);
  LoopCost cost(state.motion, state.map, options.match);
  PairTable table{periods.min_frames, within.first, {}};
  const LoopMovement movement(state);
  const double min_deviation_m =
      periods.feet ? kMinMovement * periods.feet->deviation_m : 0.0;
  std::vector<double> all;
  for (int lag = periods.min_frames; lag <= periods.max_frames; ++lag) {
    all.resize(static_cast<std::size_t>(cost.frame_count() - lag));
    cost.squared_distances(lag, all);
    std::vector<double> row;
    for (int first = within.first; first + lag <= within.last; ++first) {
      const bool may_repeat = has_same_support(marks, first, first + lag) &&
                              movement.deviation_m(first, first + lag) >= min_deviation_m;
      row.push_back(may_repeat ? all[static_cast<std::size_t>(first)] : kFarPair);
    }
    table.by_lag.push_back(std::move(row));
  }
  return table;
}

/// Returns the best pair around each two strikes of the same foot.
std::vector<LoopPair> strike_pairs(const EditState& state, const PairTable& table) {
  const int reach = strike_reach(state);
  std::vector<LoopPair> out;
  for (const auto& foot : state.contacts.feet) {
    for (const FrameRange& start : foot.stance) {
      for (const FrameRange& end : foot.stance) {
        const int lag = end.first - start.first - table.min_lag;
        if (start.first == 0 || lag < -reach ||
            lag >= static_cast<int>(table.by_lag.size()) + reach) {
          continue;
        }
        LoopPair best;
        for (int first = start.first - reach; first <= start.first + reach; ++first) {
          for (int last = end.first - reach; last <= end.first + reach; ++last) {
            const LoopPair pair{
                table.at(last - first - table.min_lag, first - table.first_frame),
                first,
                last};
            if (is_better(pair, best)) best = pair;
          }
        }
        if (best.squared < kFarPair) out.push_back(best);
      }
    }
  }
  std::sort(out.begin(), out.end(), is_better);
  return out;
}

/// Returns the given pairs and local minima, best first, far enough from each other.
std::vector<LoopPair> best_pairs(const PairTable& table,
                                 std::vector<LoopPair> out,
                                 int min_apart,
                                 int max_count) {
  std::vector<LoopPair> minima;
  for (int lag = 0; lag < static_cast<int>(table.by_lag.size()); ++lag) {
    const auto& row = table.by_lag[static_cast<std::size_t>(lag)];
    for (int k = 0; k < static_cast<int>(row.size()); ++k) {
      if (!table.is_local_minimum(lag, k)) continue;
      const int first = table.first_frame + k;
      minima.push_back({table.at(lag, k), first, first + table.min_lag + lag});
    }
  }
  std::sort(minima.begin(), minima.end(), is_better);
  max_count += static_cast<int>(out.size());
  for (const LoopPair& pair : minima) {
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

std::vector<LoopCandidate> find_loops(const EditState& state,
                                      const FindLoopsOptions& options) {
  const auto periods = loop_periods(state, options);
  if (!periods) return {};
  const SupportMarks marks = support_marks(state);
  const int min_apart = std::max(
      1, static_cast<int>(std::lround(options.min_apart_s * state.motion.rate.hz)));
  const PairTable table = pair_table(state, options, *periods, marks);
  std::vector<LoopPair> strikes = strike_pairs(state, table);
  const auto max_pairs =
      static_cast<std::size_t>(kRefinedPerCandidate * options.max_candidates);
  if (strikes.size() > max_pairs) strikes.resize(max_pairs);
  const std::vector<LoopPair> pairs =
      best_pairs(table, std::move(strikes), min_apart, static_cast<int>(max_pairs));
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
