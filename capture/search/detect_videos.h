// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "capture/search/camera_input.h"
#include "capture/tags/track_tags.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::capture {

struct DetectVideosOptions {
  /// Detect tags with the options in `tracker`.
  bool find_tags = true;
  TrackTagsOptions tracker;
  /// Detect this target's points; a target of tags has none.
  std::optional<CalibrationTarget> target{};
  /// Search every whole frame instead: three to four times the time. Adds two to four
  /// percent of sightings, which the tracker finds a frame or two later.
  bool search_every_frame = false;
  /// A recording that cannot be read completely, or at all, is not an error: the result
  /// contains the frames before the failure, and CameraDetections::broken_off.
  bool keep_broken = false;
  /// Cameras processed at the same time; 0 uses the number of cores. The result does not
  /// depend on it.
  int workers = 0;
};

/// Tracks the tags through every frame of every camera (TagTracker), and finds the points
/// of a board of squares in each (BoardFinder). The result is in the order of `inputs`.
/// Its frame numbers are those of the whole recording even if a range is given.
///
/// Frames are streamed: memory grows with the number of tags, not of images. `progress`
/// counts frames over all cameras, with kUnknownTotal if the length of a stream is
/// unknown; it is called from worker threads, one at a time. If several cameras fail, the
/// error is that of the first of them in `inputs`. Errors (kBadInput): those of
/// open_frames() and FrameSource::next(); a folder without a rate; a range beyond the end
/// of the recording; a detector option out of range; a dictionary that is not known or
/// too small. Preconditions: ranges have 0 <= first <= last; rates are positive.
[[nodiscard]] Result<std::vector<CameraDetections>> detect_tags_in_videos(
    std::span<const CameraInput> inputs,
    const DetectVideosOptions& options = {},
    const Progress& progress = {});

}  // namespace marey::capture
