// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/track_tags.h"
#include "core/board.h"
#include "core/detection.h"
#include "core/ids.h"
#include "core/progress.h"
#include "core/result.h"
#include "core/time.h"

namespace marey::capture {

/// First and last frame, both included, counted from 0.
struct FrameRange {
  int first = 0;
  int last = 0;
};

/// One camera's recording of a trial.
struct CameraInput {
  std::filesystem::path path;  ///< A video, or a folder of images.
  CameraId camera{};
  std::string name;                 ///< As messages should name it; the path when empty.
  std::optional<FrameRate> rate;    ///< Overrides the container's; a folder needs it.
  Timestamp offset{0};              ///< Frame k was exposed at k / rate + offset.
  std::optional<FrameRange> range;  ///< All frames when absent.
};

struct DetectVideosOptions {
  /// Look for tags, as `tracker` says.
  bool find_tags = true;
  TrackTagsOptions tracker;
  /// Look for this target's points; of one that is made of tags there are none.
  std::optional<CalibrationTarget> target{};
  /// Search every frame whole instead: three to four times the time, and the two to four
  /// percent of sightings that the tracker comes upon a frame or two late.
  bool search_every_frame = false;
  /// A recording that cannot be read to its end, or at all, is no error: it gives the
  /// frames up to there, and CameraDetections::broken_off.
  bool keep_broken = false;
  /// Cameras worked on at the same time; 0 takes as many as the machine has cores. The
  /// result does not depend on it.
  int workers = 0;
};

/// Follows the tags through every frame of every camera (TagTracker), and finds the
/// points of a board of squares in each (BoardFinder). The answer is in the order of
/// `inputs`, its frame numbers those of the whole recording even when a range was asked
/// for.
///
/// Frames stream through: memory grows with the tags found, not with the pictures.
/// `progress` counts frames over all cameras, with kUnknownTotal when a stream does not
/// know its length; it is called from worker threads, one at a time. When several cameras
/// fail, the error is that of the first of them in `inputs`. Errors (kBadInput): those of
/// open_frames() and FrameSource::next(); a folder without a rate; a range that the
/// recording does not reach; a detector option out of range; a dictionary that is not
/// known or too small. Precondition: ranges have 0
/// <= first <= last; rates are positive.
[[nodiscard]] Result<std::vector<CameraDetections>> detect_tags_in_videos(
    std::span<const CameraInput> inputs,
    const DetectVideosOptions& options = {},
    const Progress& progress = {});

}  // namespace marey::capture
