// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"
#include "core/motion.h"

namespace marey::edit {

/// Share of its place that each foot keeps: 1 all, 0 none. Left, right; one value
/// per frame.
using KeptFeet = std::array<std::vector<double>, 2>;

/// Returns 1 while a foot stands, with C2 fades of 0.16 s before and after the stance.
[[nodiscard]] KeptFeet keep_standing_feet(const EditState& state);
/// Returns 1 in all frames.
[[nodiscard]] KeptFeet keep_both_feet(const EditState& state);

struct HoldFeetReport {
  double lowered_m = 0.0;  ///< Largest distance by which the root was lowered.
  double missed_m = 0.0;   ///< Largest distance of a kept foot from its place.
  int missed_frame = 0;
};

/// Puts feet back to their places in `before`, after an operation moved the body: ankle,
/// rotation of the foot in the world, toes. Legs follow analytically. Where a leg would
/// have to be longer than straight (or than in `before`), the root is lowered: by a
/// smooth curve over 0.1 s that is zero at the ends of `frames`, unless these are the
/// motion's own. A foot that is kept in part comes to the place between. Only the frames
/// of the range change. Linear in frames.
/// Precondition: both motions have the state's skeleton and frames; the range is within
/// the motion, or empty.
HoldFeetReport hold_feet(const EditState& state,
                         const Motion& before,
                         const FrameRange& frames,
                         const KeptFeet& kept,
                         Motion& after);

}  // namespace marey::edit
