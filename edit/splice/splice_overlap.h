// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"

namespace marey::edit {

/// The frames in which a splice shows both motions. Entry k of the vectors belongs
/// to one frame of the result. A splice without an overlap has one entry, the join.
struct SpliceOverlap {
  std::vector<double> first_at;   ///< Frame of the first motion, with its fraction.
  std::vector<double> second_at;  ///< Frame of the second motion.
  /// Weight of the second motion for root and legs: 0 to 1, C2.
  std::vector<double> weight;
  /// The same for trunk, head and arms, which may take longer.
  std::vector<double> upper_weight;
  FrameRange body;          ///< Entries between which root and legs are mixed.
  int matched_edges = 0;    ///< Touch-downs and lift-offs that were aligned in time.
  double max_warp_s = 0.0;  ///< Largest displacement of an instant in time.
  double opposed_s = 0.0;   ///< Time in which the motions stand on opposite feet.

  [[nodiscard]] int last() const { return static_cast<int>(weight.size()) - 1; }
  /// Frames in which root and legs are mixed.
  [[nodiscard]] int body_frames() const { return body.last - body.first; }
  /// Entry of the join, up to which the result is the first motion's.
  [[nodiscard]] int join() const { return body.first + body_frames() / 2; }
};

struct SpliceOverlapOptions {
  int frames = 0;  ///< Requested length.
  /// Requested length for trunk, head and arms, if it is longer.
  int upper_frames = 0;
  /// Touch-downs and lift-offs of both motions are brought to the same instant.
  bool align_supports = true;
};

/// Plans the overlap round frame `leave` of the first and frame `enter` of the second
/// motion: half of it before these frames and half after, as far as both motions have
/// frames there; else more on the other side; else it is shorter. Both motions enter and
/// leave it with their own speed. Trunk, head and arms may have a longer one round the
/// same frames: hands that are in different places have further to go than feet.
///
/// Touch-downs and lift-offs of the same foot that are less than 0.12 s apart are aligned
/// by a monotone C2 time warp of each motion with rates between 0.5 and 2, as in
/// registration curves (Kovar and Gleicher, "Flexible automatic motion blending with
/// registration curves", 2003). Their instant in the result is the mean of both, weighted
/// as the motions are. The warp is a quintic between knots, with zero second derivative
/// at the knots. Precondition: the frames are within the motions, which have the same
/// rate.
[[nodiscard]] SpliceOverlap plan_splice_overlap(const EditState& first,
                                                int leave,
                                                const EditState& second,
                                                int enter,
                                                const SpliceOverlapOptions& options);

}  // namespace marey::edit
