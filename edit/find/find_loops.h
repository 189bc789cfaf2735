// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "edit/find/loop_pairs.h"
#include "edit/find/planar_match.h"
#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"
#include "core/base/result.h"

namespace marey::edit {

/// A pair of frames between which a motion is nearly a cycle.
struct LoopCandidate {
  int first = 0;  ///< Frame of the motion.
  int last = 0;   ///< Frame that repeats `first`: the first one after the cycle.
  /// Length of the cycle in frames, with a fraction: within half a frame of last - first.
  double period_frames = 0.0;
  /// Match of `last` (as a) with `first` (as b) over all joints.
  PlanarMatch match;
  /// Moves the posture at `first` to the one a period later: match.a_from_b, interpolated
  /// to the fraction of period_frames.
  PlanarMove travel;
  LoopEdge edge = LoopEdge::kNone;
};

struct FindLoopsOptions {
  /// Limits of the cycle's length. nullopt: 75 % and 125 % of foot_period(). [s]
  std::optional<double> min_period_s;
  std::optional<double> max_period_s;
  std::optional<FrameRange>
      within;  ///< Both frames lie in it; nullopt: the whole motion.
  MatchOptions match;
  int max_candidates = 20;
  /// Candidates are at least this far apart, in their first or their last frame. [s]
  double min_apart_s = 0.1;
  /// A pair of strikes of the same foot comes before a pair without that is at most this
  /// much better: its feet are placed by the footprints of whole stances.
  double strike_preference = 1.0;
};

/// nullopt: the options give no limits and the feet have no period; or the motion is too
/// short for the shortest cycle.
[[nodiscard]] std::optional<LoopPeriods> loop_periods(const EditState& state,
                                                      const FindLoopsOptions& options);

/// Returns an error if find_loops() would compare more than 2000 million pairs, a few
/// minutes of work. Errors (bad input): that.
[[nodiscard]] Status check_loop_search(const EditState& state,
                                       const FindLoopsOptions& options);

/// Finds pairs of frames that repeat each other, best first. All pairs in the range of
/// periods are compared by five joints, positions and velocities over five frames
/// (edit/find/loop_cost.h); the best local minima are compared again by all joints and
/// sorted by PlanarMatch::distance_m. Both frames have the same feet on the floor.
/// Empty if loop_periods() is nullopt. Time: frames times the range in frames; memory:
/// linear in frames.
[[nodiscard]] std::vector<LoopCandidate> find_loops(const EditState& state,
                                                    const FindLoopsOptions& options = {});

/// Compares one pair of frames that was chosen by hand.
/// Precondition: 0 <= first < last < frames.
[[nodiscard]] LoopCandidate compare_loop(const EditState& state,
                                         int first,
                                         int last,
                                         const MatchOptions& options = {});

/// Distances of all pairs of frames, for a picture. Cell (row, column) holds the smallest
/// distance of the pairs whose first frame is among cell_frames from row * cell_frames
/// on, and whose last frame is among those of the column.
struct LoopMap {
  int cells = 0;
  int cell_frames = 1;            ///< Frames of the motion per cell.
  std::vector<float> distance_m;  ///< [row * cells + column]; 0 below the diagonal.
};
/// Quadratic in frames, of at most 2400: longer motions are thinned out.
[[nodiscard]] LoopMap loop_map(const EditState& state,
                               int max_cells = 128,
                               const MatchOptions& options = {});

}  // namespace marey::edit
