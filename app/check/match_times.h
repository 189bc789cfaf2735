// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Renumbers the frames of `found` (one entry per camera of the session) if the frame
/// numbers of the videos are not reliable, so that equal numbers mean equal times. The
/// source of the times is:
/// - for a take: the times in its file. The constant lag of each camera becomes its
///   offset. The frames are cut to the range of the trial, which counts instants;
/// - for a trial whose session names a table of times: this table, in the same way;
/// - for videos with uneven time stamps: their own time stamps, for each video
///   separately.
///
/// Videos with a constant rate are unchanged. If the trial of a video with an uneven rate
/// sets `fps`, that value is used, with a warning.
///
/// Errors (kBadInput): the file of times of a take is missing, damaged or newer than this
/// program; it lacks a video, has no rate, or has impossible times; it has fewer instants
/// than the range of the trial; an uneven video in a trial that chooses its frames by
/// number. Precondition: `found` has all frames of the videos of a take.
[[nodiscard]] Status match_times(const recordings::Trial& trial,
                                 std::vector<CameraDetections>& found,
                                 std::vector<Finding>& findings);

/// Returns true if match_times() renumbers the frames of the trial by a file of times:
/// the trial was recorded, all its videos lie in one folder with such a file, or the
/// session names a table of times. In these cases all frames of its videos are needed.
[[nodiscard]] bool has_times_file(const recordings::Trial& trial);

}  // namespace marey::app
