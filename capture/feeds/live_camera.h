// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capture/feeds/decode_frame.h"
#include "capture/feeds/frame_feed.h"
#include "capture/tags/track_tags.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::capture {

/// Tags of one image. Its memory is reused.
struct DetectedPicture {
  std::vector<TagDetection> tags;
  double decode_s = 0.0;
  double detect_s = 0.0;
  Timestamp done{0};  ///< CLOCK_MONOTONIC, end of the detection.
  /// A reduced grey image, rows from the top, with an even width; empty if none was made.
  std::vector<std::byte> thumbnail;
  int thumbnail_width_px = 0;
  int thumbnail_height_px = 0;
};

/// Counts of a camera's images. Read from any thread.
struct LiveCameraCounts {
  std::atomic<long> pictures = 0;  ///< Received.
  std::atomic<long> dropped = 0;   ///< Lost by the driver.
  std::atomic<long> stale = 0;     ///< Skipped as too old.
  std::atomic<long> broken = 0;    ///< Not decodable, or of another size.
};

struct LiveCameraOptions {
  std::string name;
  /// An image is skipped if its predicted age after the detection is larger than this. A
  /// camera whose images are processed too slowly thus catches up. [s]
  double stale_after_s = 0.05;
  /// Interval of thumbnails in images, while thumbnails are enabled.
  int thumbnail_every = 10;
};

/// Decodes the images of one camera and detects their tags. make() is called on the
/// camera's own thread only.
class LiveCamera {
 public:
  /// `feed` must outlive it; `camera` has the expected properties of its images. Errors
  /// as for TagTracker::create().
  [[nodiscard]] static Result<std::unique_ptr<LiveCamera>> create(
      const LiveCameraOptions& options,
      const Camera& camera,
      FrameFeed& feed,
      const TagDetectorOptions& detector);

  /// Returns false if the image is skipped.
  [[nodiscard]] bool make(const RawFrame& frame, DetectedPicture& out);

  /// May be called from any thread.
  void want_thumbnails(bool wanted) { thumbnails_wanted_ = wanted; }
  [[nodiscard]] const LiveCameraCounts& counts() const { return counts_; }
  [[nodiscard]] const std::string& name() const { return options_.name; }
  [[nodiscard]] FeedHealth health() const { return feed_->health(); }

 private:
  LiveCamera(const LiveCameraOptions& options,
             const Camera& camera,
             FrameFeed& feed,
             TagTracker tracker);
  [[nodiscard]] int picture_index(const RawFrame& frame);
  void shrink(const GrayFrame& picture, DetectedPicture& out) const;

  LiveCameraOptions options_;
  int width_px_;
  int height_px_;
  FrameFeed* feed_;
  FrameDecoder decoder_;
  TagTracker tracker_;
  int last_index_ = -1;
  long made_ = 0;
  double typical_search_s_ = 0.0;  ///< Smoothed time to search an image. [s]
  std::atomic<bool> thumbnails_wanted_ = false;
  LiveCameraCounts counts_;
};

}  // namespace marey::capture
