// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: bones between repaired markers.

#include "core/marker_tracks.h"
#include "reconstruct/marker_distances.h"

namespace marey::reconstruct {

/// Moves samples of `repaired` that are not in `measured` so that markers at stable
/// distances keep them: in every frame the least sum of squares of the moves, in their
/// sigmas, and of the distances' changes, in their own; none by more than one and a half of
/// its sigmas. Sigmas stay, since distances were
/// known to those who made them. Linear in frames and stable pairs.
void hold_distances(const MarkerTracks& measured,
                    const MarkerDistances& distances,
                    MarkerTracks& repaired);

}  // namespace marey::reconstruct
