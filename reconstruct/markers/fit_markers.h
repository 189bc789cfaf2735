// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/marker_tracks.h"
#include "reconstruct/markers/markers_fit.h"

namespace marey::reconstruct {

/// Measures a person from labelled markers: segment lengths, joint centres, and each
/// marker's place, all at once by one bundle over chosen instants of all trials (Ceres),
/// with landmarks, proportions, symmetry of left and right, and pose priors as soft
/// terms. A trial of standing still is sufficient, moving trials improve the result; the
/// source of each joint is reported (JointEvidence). Hip joint centres come from the
/// spines of the pelvis (Harrington et al. 2007) as far as movement does not determine
/// them.
/// Labels without a landmark are assigned to the segment that they move with, if two
/// named markers determine its movement and the place is within its soft tissue; labels
/// that fit several segments are left out. Markers that move with another segment than
/// the one they are named for are moved there by the same rules; markers that move with
/// none are left out. Deterministic. Cost: some seconds, independent of the trials'
/// lengths, and more with hundreds of trials. Errors (kBadInput, `where` empty): fewer
/// than six labels have landmarks, or none of them is on the hips or the trunk; no frame
/// shows six of them; no body explains them.
[[nodiscard]] Result<MarkersFit> fit_markers(const MarkerSubject& subject,
                                             std::span<const MarkerTracks> trials,
                                             std::span<const NamedMarker> labels,
                                             const Progress& progress = {});

}  // namespace marey::reconstruct
