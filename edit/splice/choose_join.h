// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/find/peak_acceleration.h"
#include "edit/splice/join_motions.h"
#include "edit/state/edit_state.h"

namespace marey::edit {

/// Joins that may be made.
struct JoinChoices {
  std::vector<SpliceCandidate> pairs;  ///< Best match first; not empty.
  /// Overlaps of root and legs, shortest first; not empty. [frames]
  std::vector<int> overlaps;
  /// Longer overlaps of trunk, head and arms, shortest first; may be empty. [frames]
  std::vector<int> upper_overlaps;
  /// Decays of the displacements of a join without an overlap, shortest first; not empty.
  /// [frames]
  std::vector<int> blends;
  bool align = true;
  /// A join with a lower peak is good enough. [m/s^2]
  double max_m_per_s2 = 0.0;
};

/// Returns the first join whose joints do not accelerate more than the limit and whose
/// feet reach their footprints; if there is none, the one with the lowest peak of those
/// whose feet reach, else of all. Joins are made and measured in turn: pairs in their
/// order; for each the overlaps from the shortest on; for each the upper overlaps from
/// the shortest on, as long as a joint of the upper body has the peak. Without an
/// overlap, or without frames for one, the decays take their place. Long motions are cut
/// to some seconds round the pair for this. Cost: a join of these seconds for each trial.
/// Precondition: as join_motions().
[[nodiscard]] JoinPlan choose_join(const EditState& first,
                                   const EditState& second,
                                   const JoinChoices& choices);

}  // namespace marey::edit
