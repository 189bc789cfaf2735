// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/loop_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "edit/find/loop_cost.h"

#include "retarget/contacts/frame_marks.h"

namespace marey::edit {
namespace {

constexpr double kStrikeTolerance_s = 0.02;
/// A cycle in which the feet move less than this share of their usual movement is a rest
/// between cycles.
constexpr double kMinMovement = 0.5;
constexpr double kFar = std::numeric_limits<double>::infinity();

bool is_better(const LoopPair& a, const LoopPair& b) {
  return std::tie(a.squared, a.first, a.last) < std::tie(b.squared, b.first, b.last);
}

int strike_reach(const EditState& state) {
  return std::max(
      1, static_cast<int>(std::lround(kStrikeTolerance_s * state.motion.rate.hz)));
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

/// Two strikes of the same foot, and the best pair of frames around them.
struct StrikePair {
  int start = 0;
  int end = 0;
  LoopPair best;
};

/// Returns the pairs of strikes whose distance is in the range, by distance.
std::vector<StrikePair> strike_pairs(const EditState& state, const LoopPeriods& periods) {
  const int reach = strike_reach(state);
  const int min_lag = periods.min_frames - reach;
  const int max_lag = periods.max_frames + reach;
  std::vector<StrikePair> out;
  for (const auto& foot : state.contacts.feet) {
    const auto& stance = foot.stance;
    for (const FrameRange& start : stance) {
      if (start.first == 0) continue;
      auto end = std::lower_bound(
          stance.begin(),
          stance.end(),
          start.first + min_lag,
          [](const FrameRange& run, int frame) { return run.first < frame; });
      for (; end != stance.end() && end->first <= start.first + max_lag; ++end) {
        out.push_back({start.first, end->first, {}});
      }
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const StrikePair& a, const StrikePair& b) {
    return a.end - a.start < b.end - b.start;
  });
  return out;
}

/// Searches all pairs in the range of periods, one period after the other: the distances
/// of three of them are kept.
class PairSearch {
 public:
  PairSearch(const EditState& state,
             const FrameRange& within,
             const LoopPeriods& periods,
             const SupportMarks& marks,
             const MatchOptions& match)
      : within_(within),
        periods_(periods),
        marks_(marks),
        cost_(state.motion, state.map, match),
        movement_(state),
        min_deviation_m_(periods.feet ? kMinMovement * periods.feet->deviation_m : 0.0),
        reach_(strike_reach(state)),
        strikes_(strike_pairs(state, periods)) {}

  GoodPairs run() {
    for (int lag = periods_.min_frames; lag <= periods_.max_frames; ++lag) {
      before_.swap(here_);
      here_.swap(after_);
      fill_after(lag);
      add_minima(lag - 1);
      improve_strikes(lag);
    }
    before_.swap(here_);
    here_.swap(after_);
    after_.clear();
    add_minima(periods_.max_frames);
    std::sort(out_.minima.begin(), out_.minima.end(), is_better);
    for (const StrikePair& pair : strikes_) {
      if (pair.best.squared < kFar) out_.strikes.push_back(pair.best);
    }
    std::sort(out_.strikes.begin(), out_.strikes.end(), is_better);
    return std::move(out_);
  }

 private:
  /// Squared distances of the pairs with one period, by their first frame; those with
  /// other supports are far.
  using Row = std::vector<double>;

  static double at(const Row& row, int k) {
    return k < 0 || k >= static_cast<int>(row.size()) ? kFar
                                                      : row[static_cast<std::size_t>(k)];
  }

  void fill_after(int lag) {
    all_.resize(static_cast<std::size_t>(cost_.frame_count() - lag));
    cost_.squared_distances(lag, all_);
    after_.clear();
    for (int first = within_.first; first + lag <= within_.last; ++first) {
      const bool may_repeat =
          has_same_support(marks_, first, first + lag) &&
          movement_.deviation_m(first, first + lag) >= min_deviation_m_;
      after_.push_back(may_repeat ? all_[static_cast<std::size_t>(first)] : kFar);
    }
  }

  /// Adds the local minima of here_, which has this period.
  void add_minima(int lag) {
    for (int k = 0; k < static_cast<int>(here_.size()); ++k) {
      const double here = at(here_, k);
      if (here == kFar) continue;
      bool is_minimum = true;
      for (const Row* row : {&before_, &here_, &after_}) {
        for (int next = k - 1; next <= k + 1; ++next) {
          if (at(*row, next) < here) is_minimum = false;
        }
      }
      const int first = within_.first + k;
      if (is_minimum) out_.minima.push_back({here, first, first + lag});
    }
  }

  /// Looks for better pairs around strikes in after_, which has this period.
  void improve_strikes(int lag) {
    auto pair = std::lower_bound(
        strikes_.begin(),
        strikes_.end(),
        lag - 2 * reach_,
        [](const auto& a, int frames) { return a.end - a.start < frames; });
    for (; pair != strikes_.end() && pair->end - pair->start <= lag + 2 * reach_;
         ++pair) {
      const int low = std::max(pair->start, pair->end - lag) - reach_;
      const int high = std::min(pair->start, pair->end - lag) + reach_;
      for (int first = low; first <= high; ++first) {
        const LoopPair found{at(after_, first - within_.first), first, first + lag};
        if (is_better(found, pair->best)) pair->best = found;
      }
    }
  }

  const FrameRange within_;
  const LoopPeriods& periods_;
  const SupportMarks& marks_;
  LoopCost cost_;
  LoopMovement movement_;
  double min_deviation_m_ = 0.0;
  int reach_ = 0;
  std::vector<StrikePair> strikes_;
  Row before_;
  Row here_;
  Row after_;
  std::vector<double> all_;
  GoodPairs out_;
};

}  // namespace

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

GoodPairs good_pairs(const EditState& state,
                     const FrameRange& within,
                     const LoopPeriods& periods,
                     const SupportMarks& marks,
                     const MatchOptions& match) {
  return PairSearch(state, within, periods, marks, match).run();
}

}  // namespace marey::edit
