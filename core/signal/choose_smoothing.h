// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/signal/smoothing_spline.h"

namespace marey {

/// Fewest samples for which a penalty is chosen.
inline constexpr std::size_t kMinSmoothingSamples = 20;

/// Outcome for a channel.
enum class SmoothingState {
  kSmoothed,
  kTooShort,  ///< Fewer than kMinSmoothingSamples; left as is.
  kStraight   ///< Constant or a straight line, to rounding; left as is.
};

/// Rule by which the channels of a group share one penalty.
enum class GroupRule {
  /// Minimum over the penalty of the sum of 1 - V_min / V over the channels, where V is a
  /// channel's GCV score and V_min its minimum. No channel's share exceeds 1, so one
  /// channel without noise does not decide for the others.
  kJoint,
  kMedian  ///< Median of the channels' own penalties, in their logarithms.
};

struct ChooseSmoothingOptions {
  SplineOptions spline;
  GroupRule rule = GroupRule::kJoint;
};

/// Smoothing of one channel. Lengths are in the channel's unit.
struct ChannelSmoothing {
  SmoothingState state = SmoothingState::kTooShort;
  double own_penalty = 0.0;  ///< Minimum of its own GCV score. 0 unless smoothed.
  double noise_sigma = 0.0;  ///< Estimate at the group's penalty, for weight 1.
  double removed_rms = 0.0;  ///< Root mean square of the removed part.
  double removed_max = 0.0;  ///< Largest amount removed.
  std::size_t removed_max_sample = 0;
};

/// Smoothing of a group of channels.
struct GroupSmoothing {
  std::optional<double> penalty;  ///< None if no channel of the group was smoothed.
  double cutoff_hz = 0.0;         ///< half_power_hz() of the penalty. 0 if none.
};

/// Result of smooth_groups(): as many entries as there were channels, and groups.
struct SmoothingReport {
  std::vector<ChannelSmoothing> channels;
  std::vector<GroupSmoothing> groups;
};

/// Returns true if the channel is the line through its first and last sample, to
/// rounding. Precondition: at least 2 samples.
[[nodiscard]] bool is_straight_channel(std::span<const double> channel);

/// Penalties found by choose_penalties().
struct ChosenPenalties {
  std::vector<double> channels;  ///< Each channel's own.
  std::vector<double> groups;    ///< Each group's.
};

/// Channels with the splines that smooth them. Channels of equal weights share a spline,
/// and thereby its factorisations.
struct SmoothingChannels {
  std::vector<SmoothingSpline> splines;          ///< One per set of weights.
  std::vector<std::span<const double>> samples;  ///< One per channel. Borrowed.
  std::vector<std::size_t> spline_of;            ///< Index of each channel's spline.
};

/// Returns the penalty with the least generalised cross-validation score (Craven & Wahba
/// 1979) of each channel, and the shared penalty of each group. The search runs over a
/// fixed lattice of cut-offs, from twice the Nyquist frequency down to that of
/// max_spline_penalty(): steps of half an octave, refined to 1/16 of an octave, then a
/// parabola. Deterministic; a channel's own penalty does not depend on the other
/// channels. About 25 fits per channel, and fewer than 200 factorisations per spline.
///
/// The score assumes white noise. If the noise of consecutive samples is correlated, the
/// penalties are too small.
/// Preconditions: all channels have as many samples as their splines, all finite, and are
/// not straight; the splines have one order; groups are not empty and index channels.
/// Changes the penalties of the splines.
[[nodiscard]] ChosenPenalties choose_penalties(
    SmoothingChannels& channels,
    std::span<const std::vector<std::size_t>> groups,
    GroupRule rule = GroupRule::kJoint);

/// Smooths channels in place by splines, with one penalty per group: a noisy elbow must
/// not be smoother than its wrist. Channels in no group are left as they are.
/// Preconditions: all channels have the same number of samples, all finite; groups index
/// channels, each channel at most once; rate_hz > 0; `weights` is empty (all 1), or has
/// an entry for each channel: empty (all 1) or one weight per sample, each above 0.
[[nodiscard]] SmoothingReport smooth_groups(
    std::span<std::vector<double>> channels,
    std::span<const std::vector<std::size_t>> groups,
    double rate_hz,
    const ChooseSmoothingOptions& options = {},
    std::span<const std::vector<double>> weights = {});

}  // namespace marey
