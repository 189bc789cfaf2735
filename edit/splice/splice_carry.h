// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/frame_range.h"

namespace marey::edit {

/// Frames of a joined motion in which both motions are shown.
struct JoinFrames {
  int start = 0;  ///< Frame of the result that shows the second motion's first one.
  int join = 0;   ///< Last frame that is the first motion's.
  /// Weights of the second motion from `start` on: root, legs and annotations.
  std::span<const double> weight;
  std::span<const double> upper_weight;  ///< Trunk, head and arms.
  FrameRange body;  ///< Entries of `weight` between which root and legs are mixed.
};

/// Joins two motions on one time grid: frames up to `join` are the first one's, later
/// ones the second one's. Annotations, constraints, contacts, contact edits, lineage and
/// uncertainty go along.
///
/// An annotation that ends at the join and one of the same text that begins there become
/// one. Constraints of the same id and goal become one, too. Another constraint whose id
/// is taken gets a new one. Constraints that are active across the join fade over the
/// overlap. Curves are mixed by the weights; a motion without a curve counts as 0.
/// Uncertainty is dropped, with a finding, if one of the motions has none. Contacts:
/// join_contacts(). Precondition: same skeleton and rate; `start` <= `join`; the first
/// motion has at least the frames up to `join`.
[[nodiscard]] EditState join_states(const EditState& first,
                                    const EditState& second,
                                    const JoinFrames& frames,
                                    OpReport& report);

}  // namespace marey::edit
