// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/body.h"
#include "core/marker_tracks.h"
#include "reconstruct/solve_motion.h"

namespace marey::reconstruct {

/// The corners of the body's tags as labelled markers, where the solved motion carries
/// them: free of the noise of single pictures and of what skin does to single tags.
/// Labels are the segment, the tag and the corner in TagDetection's order:
/// "leftFoot_tag48_c0"; tags in the body's order.
///
/// Measured in frames in which a camera saw the tag; repaired in others in which the
/// segment was seen or bridged; elsewhere, and of tags that were never seen in the trial,
/// there is no sample. The first frame of a motion that starts at frame 0 is number 1, as
/// in C3D files. Preconditions: `trial` is of this body; its motion has the body's
/// skeleton. Cost: linear in samples.
[[nodiscard]] MarkerTracks tag_tracks(const Body& body, const SolvedTrial& trial);

}  // namespace marey::reconstruct
