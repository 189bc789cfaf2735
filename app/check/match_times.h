// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/check/recording_troubles.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Gives frames of `found` (one entry per camera of the session) new numbers where the
/// videos' own are not to be trusted, so that equal numbers mean equal times:
/// - of a take, by the times in its file, with each camera's constant lag as its offset,
///   and cut to the trial's range of frames, which counts instants;
/// - of a trial whose session names a table of times, by these, likewise;
/// - of videos whose own time stamps are uneven, by these, each video for itself.
/// Of steady videos nothing changes, nor of uneven ones whose trial gives an fps: it is
/// believed, with a warning.
///
/// Errors (kBadInput): a take's file of times is missing, damaged or newer; it does not
/// know the videos, tells no rate, or has times that cannot be; it has fewer instants
/// than the trial's range; an uneven video whose frames the trial chooses by number.
/// Precondition: `found` has all frames of a take's videos.
[[nodiscard]] Status match_times(const recordings::Trial& trial,
                                 std::vector<CameraDetections>& found,
                                 RecordingTroubles& troubles);

/// Whether match_times() will renumber frames by a take's file: the trial was recorded,
/// or all its videos lie in one folder with such a file, or the session names another
/// table of times. Then all frames of its videos are wanted.
[[nodiscard]] bool has_take(const recordings::Trial& trial);

}  // namespace marey::app
