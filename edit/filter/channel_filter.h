// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/frame_range.h"
#include "core/edit/edit_ops.h"
#include "core/signal/choose_smoothing.h"

namespace marey::edit {

/// One filter for all channels of a group: linear, the same for each channel.
///
/// Impacts divide the channels into pieces that are filtered apart. Within 25 ms of an
/// impact the result goes over to the unfiltered channel, which it equals at the impact.
/// Gaps divide them, too: their samples are not used and stay as they are.
class ChannelFilter {
 public:
  /// Chooses the filter for a group. The channels are used for the choice only; a
  /// constant channel (within 1e-9) does not count. `weights` is empty or has one entry
  /// per sample; a Butterworth filter does not use it. `impacts` ascend. The penalty of a
  /// spline is the median over pieces of at least 20 samples, by length; without such a
  /// piece the whole channels are used. Precondition: all channels have the same number
  /// of samples, at least 20; order and cut-off of `op` are valid.
  ChannelFilter(const FilterOp& op,
                std::span<const std::vector<double>> channels,
                std::span<const double> weights,
                std::span<const int> impacts,
                double rate_hz);
  /// Chooses the filter for a group with gaps. `seen` are the pieces between the gaps;
  /// they ascend and do not touch. Pieces of at least 20 samples choose the filter: a
  /// spline's penalty suits all of them jointly (GroupRule::kJoint), Winter's cut-off is
  /// their median, by length and variance. Preconditions as above; the pieces lie within
  /// the channels.
  ChannelFilter(const FilterOp& op,
                std::span<const std::vector<double>> channels,
                std::span<const double> weights,
                std::span<const FrameRange> seen,
                double rate_hz);

  /// Returns the number of samples that a piece must have to be filtered.
  [[nodiscard]] static std::size_t min_piece(const FilterOp& op) {
    return 2 * static_cast<std::size_t>(op.order) + 1;
  }

  /// Returns the frequency of half power; nullopt: no channel can be filtered, and run()
  /// changes nothing. [Hz]
  [[nodiscard]] std::optional<double> cutoff_hz() const { return cutoff_hz_; }
  /// Returns the share of white noise that the filter removes, as a root mean square:
  /// that of the frequencies above the cut-off, at least 0.32 (above 0.9 of the band the
  /// estimate would rest on a few frequencies). Precondition: there is a cut-off.
  [[nodiscard]] double removed_noise_share() const;

  /// Filters channels in place. Linear in samples.
  void run(std::span<std::vector<double>> channels);

 private:
  struct Piece {
    std::size_t first = 0;
    std::size_t count = 0;
    std::optional<SmoothingSpline> spline;  ///< nullopt: too short, or Butterworth.
  };

  void choose_spline(std::span<const std::vector<double>> channels,
                     std::span<const double> weights);
  void choose_joint_spline(std::span<const std::vector<double>> channels,
                           std::span<const double> weights);
  void set_spline(double penalty, std::span<const double> weights);
  void choose_butterworth(std::span<const std::vector<double>> channels,
                          std::span<const Piece> parts);

  FilterOp op_;
  double rate_hz_;
  bool has_gaps_ = false;
  std::vector<Piece> pieces_;
  std::vector<double> raw_share_;  ///< Per sample; empty without impacts.
  std::optional<double> cutoff_hz_;
};

}  // namespace marey::edit
