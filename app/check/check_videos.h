// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/check/match_times.h"
#include "core/base/result.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks what the headers of all trials' videos say, before any video is decoded.
///
/// Errors (kBadInput): a video that cannot be opened in a trial that is not a motion, or
/// in a motion of which fewer than two cameras are left; a trial's range of frames that
/// one of its videos does not reach (but for trials whose frames are matched by time); a
/// folder of images with gaps in their numbers (likewise); pictures of a camera that are
/// of another size, or turned by another rotation mark, than in an earlier trial; a table
/// of times that is not there. A motion's video that cannot be opened is a warning: the
/// motion goes on without it. Videos that are not there are check_files()'s. Cost: a few
/// tens of milliseconds a video and core.
[[nodiscard]] Status check_videos(const recordings::Session& session,
                                  RecordingTroubles& troubles);

/// Warns of videos that end before others of their trial: by more than 0.5 s and
/// 5 % of the longest. `found` one entry per camera of the session, of all frames.
/// Recordings that broke off are told elsewhere, and calibrations may begin and end as
/// they like.
void warn_of_short_videos(const recordings::Session& session,
                          const recordings::Trial& trial,
                          const std::vector<CameraDetections>& found,
                          RecordingTroubles& troubles);

}  // namespace marey::app
