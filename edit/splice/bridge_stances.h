// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/splice/plant_near.h"
#include "edit/splice/splice_carry.h"
#include "edit/state/edit_state.h"

namespace marey::edit {

/// Returns where the feet of a joined motion stand, for plant_feet_near().
///
/// A stance on one side of the join stands where it does in its own motion, whatever the
/// mixed legs do. A stance across the join has one footprint: each side's foot is moved
/// and turned about the vertical by half of the gap between both, for the whole stance;
/// so a foot that turns while it stands turns as in its motion. Within the overlap both
/// are mixed by the weights. Other frames have the feet of `out`. Linear in frames.
/// Precondition: `out` is the join of both, its poses mixed (mix_overlap()).
[[nodiscard]] FootWays bridge_stances(const EditState& first,
                                      const EditState& second,
                                      const JoinFrames& frames,
                                      const EditState& out);

}  // namespace marey::edit
