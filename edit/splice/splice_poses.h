// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/splice/splice_carry.h"
#include "edit/state/edit_state.h"
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"

namespace marey::edit {

/// Returns the mean distance from the second motion's bearing feet to the first one's,
/// over the frames of the overlap in which the same foot bears in both; 0 if there are
/// none. With it a stance across the join has one footprint. Horizontal. [m]
/// Precondition: as join_states(); both motions show the frames of the overlap.
[[nodiscard]] glm::dvec3 footprint_gap(const EditState& first,
                                       const EditState& second,
                                       const JoinFrames& frames);

/// Mixes the poses of the overlap by its weights, trunk, head and arms by their own:
/// rotations the way that is shorter at the join, which they keep over the overlap; the
/// root linearly. The root is then moved so that the feet that bear in `out` go from
/// their place in the first motion to that in the second one: without it the mixed legs
/// would make them slide (design of the anchored root: a foot counts as it bears, ramped
/// over 0.15 s). Linear in the overlap. Precondition: `out` is their join
/// (join_states()).
void mix_overlap(const EditState& first,
                 const EditState& second,
                 const JoinFrames& frames,
                 EditState& out);

/// Moves both sides of a join without an overlap towards each other: half of the gap
/// between the poses each, which decays over `blend_frames`, and half of the gap between
/// their velocities, which decays over half of that or 0.15 s, with continuous speed and
/// acceleration (quintics). A side with fewer frames has less time; a side with one frame
/// leaves the gap to the other. Values and velocities meet at the join. Returns the
/// frames that changed; last < first: none. Precondition: as mix_overlap(), with one
/// weight.
FrameRange displace_join(const EditState& first,
                         const EditState& second,
                         const JoinFrames& frames,
                         int blend_frames,
                         EditState& out);

}  // namespace marey::edit
