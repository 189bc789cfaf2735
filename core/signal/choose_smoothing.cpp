// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/choose_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/assert.h"

namespace marey {
namespace {

constexpr int kLatticePerOctave = 16;
constexpr int kLatticeCoarse = 8;

/// ln of the penalty at a lattice point; may lie between points.
double lattice_log_penalty(double point, int order) {
  const double log_w =
      std::log(2.0 * std::numbers::pi) - std::numbers::ln2 * point / kLatticePerOctave;
  return std::log(std::numbers::sqrt2 - 1.0) - 2.0 * order * log_w;
}

int lattice_size(SplineOptions options) {
  const double max = std::log(max_spline_penalty(options));
  int size = 0;
  while (lattice_log_penalty(size, options.order) < max) ++size;
  return size;
}

/// ln GCV of channels at lattice points, computed at first use.
class LatticeScores {
 public:
  explicit LatticeScores(SmoothingChannels& channels)
      : channels_(channels),
        options_(channels.splines.front().options()),
        size_(lattice_size(options_)),
        scores_(channels.samples.size() * static_cast<std::size_t>(size_)),
        known_(scores_.size(), false),
        minima_(channels.samples.size(), std::numeric_limits<double>::infinity()) {}

  [[nodiscard]] int size() const { return size_; }

  /// Computes the scores of the listed channels at one point, unless known.
  void compute(int point, std::span<const std::size_t> channels) {
    for (std::size_t spline = 0; spline < channels_.splines.size(); ++spline) {
      wanted_.clear();
      for (const std::size_t channel : channels) {
        const std::size_t at = index(channel, point);
        if (known_[at] || channels_.spline_of[channel] != spline) continue;
        known_[at] = true;
        wanted_.push_back(channel);
      }
      if (!wanted_.empty()) score_wanted(point, channels_.splines[spline]);
    }
  }

  /// Returns ln GCV of a channel. Precondition: computed.
  [[nodiscard]] double at(std::size_t channel, int point) const {
    MAREY_ASSERT(known_[index(channel, point)]);
    return scores_[index(channel, point)];
  }

  /// Returns the sum of 1 - V_min / V over the channels, V_min the least score so far.
  /// Precondition: their scores at the point are computed.
  [[nodiscard]] double loss(std::span<const std::size_t> channels, int point) const {
    double sum = 0.0;
    for (const std::size_t channel : channels) {
      sum -= std::expm1(minima_[channel] - at(channel, point));
    }
    return sum;
  }

 private:
  void score_wanted(int point, SmoothingSpline& spline) {
    spline.set_penalty(std::exp(lattice_log_penalty(point, options_.order)));
    batch_.clear();
    for (const std::size_t channel : wanted_) {
      batch_.push_back(channels_.samples[channel]);
    }
    batch_scores_.resize(batch_.size());
    spline.score(batch_, batch_scores_);
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const double gcv =
          std::max(batch_scores_[i].gcv, std::numeric_limits<double>::min());
      scores_[index(wanted_[i], point)] = std::log(gcv);
      minima_[wanted_[i]] = std::min(minima_[wanted_[i]], std::log(gcv));
    }
  }

  [[nodiscard]] std::size_t index(std::size_t channel, int point) const {
    return channel * static_cast<std::size_t>(size_) + static_cast<std::size_t>(point);
  }

  SmoothingChannels& channels_;
  SplineOptions options_;
  int size_;
  std::vector<double> scores_;
  std::vector<bool> known_;
  std::vector<double> minima_;  // Least score of each channel so far.
  std::vector<std::size_t> wanted_;
  std::vector<std::span<const double>> batch_;
  std::vector<SplineFit> batch_scores_;
};

/// Search for all sets at once, so that one factorisation serves all sets that need it. A
/// set of one channel minimises ln GCV, a larger one the joint loss, for which the minima
/// of its channels must be known.
class LatticeSearch {
 public:
  LatticeSearch(LatticeScores& scores, std::span<const std::vector<std::size_t>> sets)
      : scores_(scores), sets_(sets), best_(sets.size(), 0) {
    for (const auto& set : sets) {
      MAREY_ASSERT(!set.empty());
      members_.insert(members_.end(), set.begin(), set.end());
    }
  }

  /// Returns the best lattice point of each set, refined by a parabola.
  [[nodiscard]] std::vector<double> run() {
    scan();
    for (int step = kLatticeCoarse / 2; step > 0; step /= 2) {
      while (improve(step)) {
      }
    }
    std::vector<double> points;
    for (std::size_t set = 0; set < sets_.size(); ++set) points.push_back(vertex(set));
    return points;
  }

 private:
  void scan() {
    for (int point = 0; point < scores_.size(); point += kLatticeCoarse) {
      scores_.compute(point, members_);
      for (std::size_t set = 0; set < sets_.size(); ++set) {
        if (value(set, point) < value(set, best_[set])) best_[set] = point;
      }
    }
  }

  /// Moves each set to a better neighbour at this distance. Returns whether one moved.
  bool improve(int step) {
    std::vector<std::vector<std::size_t>> needs(static_cast<std::size_t>(scores_.size()));
    for (std::size_t set = 0; set < sets_.size(); ++set) {
      for (const int point : {best_[set] - step, best_[set] + step}) {
        if (!inside(point)) continue;
        auto& need = needs[static_cast<std::size_t>(point)];
        need.insert(need.end(), sets_[set].begin(), sets_[set].end());
      }
    }
    for (int point = 0; point < scores_.size(); ++point) {
      scores_.compute(point, needs[static_cast<std::size_t>(point)]);
    }
    bool moved = false;
    for (std::size_t set = 0; set < sets_.size(); ++set) {
      const int before = best_[set];
      for (const int point : {before - step, before + step}) {
        if (inside(point) && value(set, point) < value(set, best_[set])) {
          best_[set] = point;
          moved = true;
        }
      }
    }
    return moved;
  }

  [[nodiscard]] double vertex(std::size_t set) const {
    const int best = best_[set];
    if (!inside(best - 1) || !inside(best + 1)) return best;
    const double before = value(set, best - 1);
    const double after = value(set, best + 1);
    const double curvature = before - 2.0 * value(set, best) + after;
    if (curvature <= 0.0) return best;
    return best + std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
  }

  [[nodiscard]] bool inside(int point) const {
    return point >= 0 && point < scores_.size();
  }
  [[nodiscard]] double value(std::size_t set, int point) const {
    const auto& channels = sets_[set];
    return channels.size() == 1 ? scores_.at(channels[0], point)
                                : scores_.loss(channels, point);
  }

  LatticeScores& scores_;
  std::span<const std::vector<std::size_t>> sets_;
  std::vector<std::size_t> members_;  // Channels of all sets.
  std::vector<int> best_;
};

double median_log(std::vector<double> penalties) {
  std::sort(penalties.begin(), penalties.end());
  const std::size_t half = penalties.size() / 2;
  if (penalties.size() % 2 == 1) return penalties[half];
  return std::sqrt(penalties[half - 1]) * std::sqrt(penalties[half]);
}

/// Channels of each group that can be smoothed; their indices.
std::vector<std::vector<std::size_t>> smoothable_channels(
    std::span<const std::vector<double>> channels,
    std::span<const std::vector<std::size_t>> groups,
    SmoothingReport& report) {
  std::vector<std::vector<std::size_t>> kept(groups.size());
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (const std::size_t channel : groups[group]) {
      MAREY_ASSERT(channel < channels.size());
      auto& state = report.channels[channel].state;
      if (channels[channel].size() < kMinSmoothingSamples) {
        state = SmoothingState::kTooShort;
      } else if (is_straight_channel(channels[channel])) {
        state = SmoothingState::kStraight;
      } else {
        state = SmoothingState::kSmoothed;
        kept[group].push_back(channel);
      }
    }
  }
  return kept;
}

/// The listed channels; those of equal weights share a spline.
SmoothingChannels with_shared_splines(std::span<const std::vector<double>> channels,
                                      std::span<const std::size_t> listed,
                                      SplineOptions options,
                                      std::span<const std::vector<double>> weights) {
  SmoothingChannels result;
  std::vector<std::span<const double>> known;  // Weights of each spline.
  for (const std::size_t channel : listed) {
    std::span<const double> own;
    if (!weights.empty()) own = weights[channel];
    std::size_t spline = 0;
    while (
        spline < known.size() &&
        !std::equal(own.begin(), own.end(), known[spline].begin(), known[spline].end())) {
      ++spline;
    }
    if (spline == known.size()) {
      known.push_back(own);
      result.splines.emplace_back(channels[channel].size(), options, own);
    }
    result.samples.emplace_back(channels[channel]);
    result.spline_of.push_back(spline);
  }
  return result;
}

void smooth_channel(SmoothingSpline& spline,
                    std::vector<double>& channel,
                    std::vector<double>& fitted,
                    ChannelSmoothing& report) {
  fitted.resize(channel.size());
  report.noise_sigma = spline.fit(channel, fitted).noise_sigma;
  double squares = 0.0;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    const double removed = std::abs(channel[i] - fitted[i]);
    squares += removed * removed;
    if (removed > report.removed_max) {
      report.removed_max = removed;
      report.removed_max_sample = i;
    }
  }
  report.removed_rms = std::sqrt(squares / static_cast<double>(channel.size()));
  channel.swap(fitted);
}

}  // namespace

bool is_straight_channel(std::span<const double> channel) {
  const double first = channel.front();
  const double slope = (channel.back() - first) / static_cast<double>(channel.size() - 1);
  double size = 0.0;
  double bend = 0.0;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    size = std::max(size, std::abs(channel[i]));
    bend = std::max(bend, std::abs(channel[i] - first - slope * static_cast<double>(i)));
  }
  return bend <= 1e-12 * size;
}

ChosenPenalties choose_penalties(SmoothingChannels& channels,
                                 std::span<const std::vector<std::size_t>> groups,
                                 GroupRule rule) {
  if (channels.samples.empty()) return {};
  MAREY_ASSERT(channels.spline_of.size() == channels.samples.size());
  LatticeScores scores(channels);
  const int order = channels.splines.front().options().order;
  const auto search = [&](std::span<const std::vector<std::size_t>> sets) {
    std::vector<double> penalties = LatticeSearch(scores, sets).run();
    for (double& penalty : penalties) {
      penalty = std::exp(lattice_log_penalty(penalty, order));
    }
    return penalties;
  };
  std::vector<std::vector<std::size_t>> singles;
  for (std::size_t i = 0; i < channels.samples.size(); ++i) singles.push_back({i});
  ChosenPenalties chosen;
  chosen.channels = search(singles);
  if (rule == GroupRule::kJoint) {
    chosen.groups = search(groups);
    return chosen;
  }
  for (const auto& group : groups) {
    std::vector<double> penalties;
    penalties.reserve(group.size());
    for (const std::size_t i : group) penalties.push_back(chosen.channels[i]);
    chosen.groups.push_back(median_log(std::move(penalties)));
  }
  return chosen;
}

SmoothingReport smooth_groups(std::span<std::vector<double>> channels,
                              std::span<const std::vector<std::size_t>> groups,
                              double rate_hz,
                              const ChooseSmoothingOptions& options,
                              std::span<const std::vector<double>> weights) {
  MAREY_ASSERT(rate_hz > 0.0);
  MAREY_ASSERT(weights.empty() || weights.size() == channels.size());
  SmoothingReport report;
  report.channels.resize(channels.size());
  report.groups.resize(groups.size());
  const auto kept = smoothable_channels(channels, groups, report);

  std::vector<std::size_t> listed;             // Channel of each entry of `samples`.
  std::vector<std::vector<std::size_t>> sets;  // Entries of `samples`.
  std::vector<std::size_t> group_of_set;
  for (std::size_t group = 0; group < kept.size(); ++group) {
    if (kept[group].empty()) continue;
    sets.emplace_back();
    group_of_set.push_back(group);
    for (const std::size_t channel : kept[group]) {
      sets.back().push_back(listed.size());
      listed.push_back(channel);
    }
  }
  SmoothingChannels smoothed =
      with_shared_splines(channels, listed, options.spline, weights);
  const auto chosen = choose_penalties(smoothed, sets, options.rule);
  std::vector<double> fitted;
  for (std::size_t set = 0; set < sets.size(); ++set) {
    const double penalty = chosen.groups[set];
    report.groups[group_of_set[set]] = {penalty,
                                        half_power_hz(penalty, rate_hz, options.spline)};
    for (SmoothingSpline& spline : smoothed.splines) spline.set_penalty(penalty);
    for (const std::size_t i : sets[set]) {
      ChannelSmoothing& channel = report.channels[listed[i]];
      channel.own_penalty = chosen.channels[i];
      smooth_channel(
          smoothed.splines[smoothed.spline_of[i]], channels[listed[i]], fitted, channel);
    }
  }
  return report;
}

}  // namespace marey
