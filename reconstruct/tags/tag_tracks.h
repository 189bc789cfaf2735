// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/body.h"
#include "core/marker_tracks.h"
#include "reconstruct/tags/solve_motion.h"

namespace marey::reconstruct {

/// Computes the corners of the body's tags as labelled markers, at their places on the
/// solved motion: free of the noise of single pictures and of the soft-tissue artefact of
/// single tags. Labels are the segment, the tag and the corner in TagDetection's order:
/// "leftFoot_tag48_c0"; tags in the body's order.
/// Samples are measured in frames in which a camera saw the tag, and repaired in others
/// in which the segment was seen or bridged. There is no sample elsewhere, nor of tags
/// that were never seen in the trial. The first frame of a motion that starts at frame 0
/// is number 1, as in C3D files. Preconditions: `trial` is of this body; its motion has
/// the body's skeleton. Cost: linear in samples.
[[nodiscard]] MarkerTracks tag_tracks(const Body& body, const SolvedTrial& trial);

}  // namespace marey::reconstruct
