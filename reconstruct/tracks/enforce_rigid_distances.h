// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: rigid distances between repaired markers.

#include "core/marker_tracks.h"
#include "reconstruct/tracks/marker_distances.h"

namespace marey::reconstruct {

/// Moves samples of `repaired` that are not in `measured` so that markers at stable
/// distances keep them: in every frame the least sum of squares of the moves, in their
/// sigmas, and of the distances' changes, in their own. No move exceeds one and a half of
/// its sigmas. Sigmas do not change: the repair already used the distances. Linear in
/// frames and stable pairs.
void enforce_rigid_distances(const MarkerTracks& measured,
                             const MarkerDistances& distances,
                             MarkerTracks& repaired);

}  // namespace marey::reconstruct
