// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/filter/channel_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "edit/signal/butterworth.h"

#include "core/base/assert.h"
#include "core/signal/smoothing_spline.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

using ChannelList = std::vector<std::vector<double>>;

/// Returns a part of the channels that vary in it.
ChannelList varying_part(std::span<const std::vector<double>> channels,
                         std::size_t first,
                         std::size_t count) {
  constexpr double kConstant = 1e-9;
  ChannelList out;
  for (const auto& channel : channels) {
    const auto from = channel.begin() + static_cast<std::ptrdiff_t>(first);
    std::vector<double> part(from, from + static_cast<std::ptrdiff_t>(count));
    const auto [low, high] = std::minmax_element(part.begin(), part.end());
    if (*high - *low > kConstant) out.push_back(std::move(part));
  }
  return out;
}

/// Returns the penalty that suits a part of the channels best.
std::optional<double> best_penalty(ChannelList channels,
                                   std::span<const double> weights,
                                   SplineOptions options,
                                   double rate_hz) {
  if (channels.empty()) return std::nullopt;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < channels.size(); ++i) all.push_back(i);
  ChannelList all_weights;
  if (!weights.empty()) {
    all_weights.assign(channels.size(), {weights.begin(), weights.end()});
  }
  const std::vector<std::vector<std::size_t>> groups{all};
  return smooth_groups(
             channels, groups, rate_hz, {options, GroupRule::kJoint}, all_weights)
      .groups[0]
      .penalty;
}

/// A value that counts as often as its weight.
struct Weighted {
  double value = 0.0;
  double weight = 0.0;
};

double weighted_median(std::vector<Weighted> values) {
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) {
    return a.value < b.value;
  });
  double total = 0.0;
  for (const Weighted& v : values) total += v.weight;
  double sum = 0.0;
  for (const Weighted& v : values) {
    sum += v.weight;
    if (sum >= 0.5 * total) return v.value;
  }
  return values.back().value;
}

double variance_of(const std::vector<double>& channel) {
  double mean = 0.0;
  double squares = 0.0;
  for (const double value : channel) mean += value;
  mean /= static_cast<double>(channel.size());
  for (const double value : channel) squares += (value - mean) * (value - mean);
  return squares / static_cast<double>(channel.size());
}

}  // namespace

ChannelFilter::ChannelFilter(const FilterOp& op,
                             std::span<const std::vector<double>> channels,
                             std::span<const double> weights,
                             std::span<const int> impacts,
                             double rate_hz)
    : op_(op), rate_hz_(rate_hz) {
  if (channels.empty()) return;
  const std::size_t count = channels[0].size();
  MAREY_ASSERT(count >= kMinSmoothingSamples);
  // The sample of an impact belongs to both pieces.
  std::size_t first = 0;
  for (const int impact : impacts) {
    const auto at = static_cast<std::size_t>(impact);
    pieces_.push_back({first, at - first + 1, std::nullopt});
    first = at;
  }
  pieces_.push_back({first, count - first, std::nullopt});
  if (!impacts.empty()) {
    constexpr double kBlend_s = 0.025;
    raw_share_.assign(count, 0.0);
    // Zero further away.
    const auto reach = static_cast<std::size_t>(std::ceil(kBlend_s * rate_hz));
    for (const int impact : impacts) {
      const auto at = static_cast<std::size_t>(impact);
      const std::size_t end = std::min(count, at + reach + 1);
      for (std::size_t t = at - std::min(at, reach); t < end; ++t) {
        const double away_s = std::abs(static_cast<double>(t) - impact) / rate_hz;
        raw_share_[t] =
            std::max(raw_share_[t], 1.0 - smooth_step(away_s / kBlend_s));
      }
    }
  }
  if (op.method == FilterMethod::kButterworth) {
    choose_butterworth(channels, std::array{Piece{0, count, std::nullopt}});
  } else {
    choose_spline(channels, weights);
  }
}

ChannelFilter::ChannelFilter(const FilterOp& op,
                             std::span<const std::vector<double>> channels,
                             std::span<const double> weights,
                             std::span<const FrameRange> seen,
                             double rate_hz)
    : op_(op), rate_hz_(rate_hz), has_gaps_(true) {
  for (const FrameRange& piece : seen) {
    pieces_.push_back({static_cast<std::size_t>(piece.first),
                       static_cast<std::size_t>(piece.last - piece.first + 1),
                       std::nullopt});
  }
  if (channels.empty()) return;
  if (op.method == FilterMethod::kButterworth) {
    choose_butterworth(channels, pieces_);
  } else {
    choose_joint_spline(channels, weights);
  }
}

double ChannelFilter::removed_noise_share() const {
  MAREY_ASSERT(cutoff_hz_);
  constexpr double kLeastNoise = 0.1;
  return std::sqrt(std::max(1.0 - *cutoff_hz_ / (0.5 * rate_hz_), kLeastNoise));
}

void ChannelFilter::choose_spline(std::span<const std::vector<double>> channels,
                                  std::span<const double> weights) {
  const SplineOptions options{op_.order};
  const auto part_of = [&](std::size_t first, std::size_t count) {
    return weights.empty() ? weights : weights.subspan(first, count);
  };
  std::vector<Weighted> found;
  for (const Piece& piece : pieces_) {
    if (piece.count < kMinSmoothingSamples) continue;
    const auto penalty = best_penalty(varying_part(channels, piece.first, piece.count),
                                      part_of(piece.first, piece.count),
                                      options,
                                      rate_hz_);
    if (penalty) found.push_back({*penalty, static_cast<double>(piece.count)});
  }
  if (found.empty() && pieces_.size() > 1) {
    const auto penalty = best_penalty(
        varying_part(channels, 0, channels[0].size()), weights, options, rate_hz_);
    if (penalty) found.push_back({*penalty, 1.0});
  }
  if (!found.empty()) set_spline(weighted_median(std::move(found)), weights);
}

void ChannelFilter::choose_joint_spline(std::span<const std::vector<double>> channels,
                                        std::span<const double> weights) {
  SmoothingChannels all;
  std::vector<std::size_t> group;
  for (const Piece& piece : pieces_) {
    if (piece.count < kMinSmoothingSamples) continue;
    all.splines.emplace_back(
        piece.count,
        SplineOptions{op_.order},
        weights.empty() ? weights : weights.subspan(piece.first, piece.count));
    for (const auto& channel : channels) {
      const auto part = std::span(channel).subspan(piece.first, piece.count);
      if (is_straight_channel(part)) continue;
      group.push_back(all.samples.size());
      all.samples.push_back(part);
      all.spline_of.push_back(all.splines.size() - 1);
    }
  }
  if (group.empty()) return;
  const std::vector<std::vector<std::size_t>> groups{group};
  set_spline(choose_penalties(all, groups).groups[0], weights);
}

void ChannelFilter::set_spline(double penalty, std::span<const double> weights) {
  const SplineOptions options{op_.order};
  cutoff_hz_ = half_power_hz(penalty, rate_hz_, options);
  for (Piece& piece : pieces_) {
    if (piece.count < min_piece(op_)) continue;
    piece.spline.emplace(
        piece.count,
        options,
        weights.empty() ? weights : weights.subspan(piece.first, piece.count));
    piece.spline->set_penalty(penalty);
  }
}

void ChannelFilter::choose_butterworth(std::span<const std::vector<double>> channels,
                                       std::span<const Piece> parts) {
  std::vector<std::pair<ChannelList, std::size_t>> varying;
  for (const Piece& part : parts) {
    if (part.count < kMinSmoothingSamples) continue;
    ChannelList list = varying_part(channels, part.first, part.count);
    if (!list.empty()) varying.emplace_back(std::move(list), part.count);
  }
  if (varying.empty()) return;
  // A filter needs a cut-off below half the rate.
  const double highest_hz = 0.45 * rate_hz_;
  if (op_.cutoff == CutoffRule::kGiven) cutoff_hz_ = op_.cutoff_hz;
  if (op_.cutoff == CutoffRule::kYu) {
    constexpr double kMaxYuRate_hz = 1183.0;
    cutoff_hz_ = std::min(yu_cutoff_hz(std::min(rate_hz_, kMaxYuRate_hz)), highest_hz);
  }
  if (op_.cutoff != CutoffRule::kWinter) return;
  std::vector<Weighted> found;
  for (const auto& [list, count] : varying) {
    // The sum of squares with gaps; with one part its length does not matter.
    const double length = has_gaps_ ? static_cast<double>(count) : 1.0;
    for (const auto& channel : list) {
      const auto cutoff_hz = winter_cutoff_hz(channel, rate_hz_);
      if (cutoff_hz) found.push_back({*cutoff_hz, length * variance_of(channel)});
    }
  }
  if (!found.empty()) {
    cutoff_hz_ = std::min(weighted_median(std::move(found)), highest_hz);
  }
}

void ChannelFilter::run(std::span<std::vector<double>> channels) {
  if (!cutoff_hz_) return;
  for (std::vector<double>& channel : channels) {
    std::vector<double> out = channel;
    for (Piece& piece : pieces_) {
      const std::span part = std::span(channel).subspan(piece.first, piece.count);
      std::vector<double> fitted(part.begin(), part.end());
      const bool is_too_short = has_gaps_ && piece.count < min_piece(op_);
      if (op_.method == FilterMethod::kButterworth && !is_too_short) {
        filter_butterworth(fitted, *cutoff_hz_, rate_hz_);
      } else if (piece.spline) {
        (void)piece.spline->fit(part, fitted);
      }
      std::copy(fitted.begin(),
                fitted.end(),
                out.begin() + static_cast<std::ptrdiff_t>(piece.first));
    }
    for (std::size_t t = 0; t < raw_share_.size(); ++t) {
      out[t] += raw_share_[t] * (channel[t] - out[t]);
    }
    channel.swap(out);
  }
}

}  // namespace marey::edit
