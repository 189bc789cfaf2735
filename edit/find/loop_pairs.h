// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "edit/find/foot_period.h"
#include "edit/find/planar_match.h"
#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"

namespace marey::edit {

/// Contacts of the feet at the start and the end of a cycle.
enum class LoopEdge { kLeftStrike, kRightStrike, kNone };

/// The range of cycle lengths that find_loops() searches.
struct LoopPeriods {
  int min_frames = 0;
  int max_frames = 0;
  std::optional<FootPeriod> feet;  ///< If the options do not give both limits.
};

/// Feet on the floor, and the edge, of each frame.
struct SupportMarks {
  std::vector<int> feet;  ///< 1: left, 2: right, 3: both.
  std::vector<LoopEdge> edge;
};

[[nodiscard]] SupportMarks support_marks(const EditState& state);

/// Returns the edge that both frames are near; kNone if there is none.
[[nodiscard]] LoopEdge common_edge(const SupportMarks& marks, int first, int last);

/// Two frames, and the squared distance of their surroundings. [m^2]
struct LoopPair {
  double squared = std::numeric_limits<double>::infinity();
  int first = 0;
  int last = 0;
};

/// Pairs of frames that may be the ends of a cycle, best first.
struct GoodPairs {
  std::vector<LoopPair> strikes;  ///< The best around each two strikes of a foot.
  std::vector<LoopPair> minima;   ///< Local minima of the distance.
};

/// Compares all pairs of frames in the range of periods (edit/find/loop_cost.h). Both
/// frames have the same feet on the floor, and the feet move in between.
/// Time: frames times periods. Memory: linear in frames.
/// Precondition: `within` lies in the motion; the marks are those of the state.
[[nodiscard]] GoodPairs good_pairs(const EditState& state,
                                   const FrameRange& within,
                                   const LoopPeriods& periods,
                                   const SupportMarks& marks,
                                   const MatchOptions& match);

}  // namespace marey::edit
