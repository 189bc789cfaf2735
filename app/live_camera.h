// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/frame_feed.h"
#include "capture/decode_frame.h"
#include "capture/track_tags.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::app {

/// What was made of one picture. Its places are used again and again.
struct DetectedPicture {
  std::vector<TagDetection> tags;
  double decode_s = 0.0;
  double detect_s = 0.0;
  Timestamp done{0};  ///< CLOCK_MONOTONIC, when the tags were found.
  /// A small grey picture of the same, rows from the top, its width even; empty when none
  /// was made.
  std::vector<std::byte> thumbnail;
  int thumbnail_width_px = 0;
  int thumbnail_height_px = 0;
};

/// What became of a camera's pictures; of any thread.
struct LiveCameraCounts {
  std::atomic<long> pictures = 0;  ///< That came.
  std::atomic<long> dropped = 0;   ///< Lost before they came to us.
  std::atomic<long> stale = 0;     ///< Passed over: too old to be waited for.
  std::atomic<long> broken = 0;    ///< Could not be decoded, or of another size.
};

struct LiveCameraOptions {
  std::string name;
  /// A picture that is likely to be older than this once it was searched is passed over,
  /// so that a camera whose pictures are searched too slowly catches up. [s]
  double stale_after_s = 0.05;
  /// A thumbnail is made of every so-many-th picture, while any are wanted.
  int thumbnail_every = 10;
};

/// One camera's pictures to tags: decoded, then searched by a tracking detector. make()
/// belongs to the camera's own thread.
class LiveCamera {
 public:
  /// `feed` outlives it; `camera` is what its pictures are expected to be like.
  /// Errors: TagTracker::create()'s.
  [[nodiscard]] static Result<std::unique_ptr<LiveCamera>> create(
      const LiveCameraOptions& options,
      const Camera& camera,
      FrameFeed& feed,
      const capture::TagDetectorOptions& detector);

  /// False for a picture that is to be passed over.
  [[nodiscard]] bool make(const capture::RawFrame& frame, DetectedPicture& out);

  /// From any thread.
  void want_thumbnails(bool wanted) { thumbnails_wanted_ = wanted; }
  [[nodiscard]] const LiveCameraCounts& counts() const { return counts_; }
  [[nodiscard]] const std::string& name() const { return options_.name; }
  [[nodiscard]] FeedHealth health() const { return feed_->health(); }

 private:
  LiveCamera(const LiveCameraOptions& options,
             const Camera& camera,
             FrameFeed& feed,
             capture::TagTracker tracker);
  [[nodiscard]] int picture_index(const capture::RawFrame& frame);
  void shrink(const capture::GrayFrame& picture, DetectedPicture& out) const;

  LiveCameraOptions options_;
  int width_px_;
  int height_px_;
  FrameFeed* feed_;
  capture::FrameDecoder decoder_;
  capture::TagTracker tracker_;
  int last_index_ = -1;
  long made_ = 0;
  double usual_s_ = 0.0;  ///< What a picture takes to be searched.
  std::atomic<bool> thumbnails_wanted_ = false;
  LiveCameraCounts counts_;
};

}  // namespace marey::app
