// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/live_camera.h"

#include <algorithm>
#include <utility>

#include "core/base/monotonic_clock.h"
#include "core/base/stopwatch.h"

namespace marey::capture {
namespace {

/// Weight of the last search in the smoothed search time.
constexpr double kSearchTimeGain = 0.2;
constexpr double kSearchTimeDecay = 0.9;
/// Reduces 1280 x 720 to 320 x 180: sufficient to see the subject's position.
constexpr int kShrink = 4;

}  // namespace

Result<std::unique_ptr<LiveCamera>> LiveCamera::create(
    const LiveCameraOptions& options,
    const Camera& camera,
    FrameFeed& feed,
    const TagDetectorOptions& detector) {
  TrackTagsOptions tracking = live_tracking();
  tracking.detector = detector;
  auto tracker = TagTracker::create(tracking);
  if (!tracker) return tracker.error();
  return std::unique_ptr<LiveCamera>(
      new LiveCamera(options, camera, feed, *std::move(tracker)));
}

LiveCamera::LiveCamera(const LiveCameraOptions& options,
                       const Camera& camera,
                       FrameFeed& feed,
                       TagTracker tracker)
    : options_(options),
      width_px_(camera.intrinsics.width_px),
      height_px_(camera.intrinsics.height_px),
      feed_(&feed),
      decoder_(options.name),
      tracker_(std::move(tracker)) {
  // The first image is searched completely and without warm buffers: twice the duration
  // of a frame. This one is a dummy that no group waits for.
  const std::vector<std::uint8_t> nothing(
      static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_), 128);
  GrayFrame first;
  first.pixels = nothing.data();
  first.width_px = width_px_;
  first.height_px = height_px_;
  first.stride = width_px_;
  first.index = last_index_;
  (void)tracker_.track(first);
}

/// The tracker predicts by the number of images between two; lost images count.
int LiveCamera::picture_index(const RawFrame& frame) {
  // Sequence numbers restart after an outage of unknown length.
  last_index_ += 1 + std::clamp(frame.dropped_before, 0, 1000);
  return last_index_;
}

bool LiveCamera::make(const RawFrame& frame, DetectedPicture& out) {
  ++counts_.pictures;
  counts_.dropped += frame.dropped_before;
  const int number = picture_index(frame);
  if (seconds(monotonic_now() - frame.time) + typical_search_s_ >
      options_.stale_after_s) {
    // Decays slowly; otherwise one slow search could stop all further ones.
    typical_search_s_ *= kSearchTimeDecay;
    ++counts_.stale;
    return false;
  }
  const Stopwatch decoding;
  const auto picture = decoder_.decode(frame, feed_->settings(), number);
  out.decode_s = decoding.seconds();
  if (!picture || picture->width_px != width_px_ || picture->height_px != height_px_) {
    ++counts_.broken;
    return false;
  }
  const Stopwatch detecting;
  const std::vector<TagDetection>& tags = tracker_.track(*picture);
  out.tags.assign(tags.begin(), tags.end());
  out.detect_s = detecting.seconds();
  typical_search_s_ += kSearchTimeGain * (out.detect_s - typical_search_s_);
  out.thumbnail.clear();
  if (thumbnails_wanted_ && made_ % options_.thumbnail_every == 0) shrink(*picture, out);
  ++made_;
  out.done = monotonic_now();
  return true;
}

/// Averages each block of pixels. Columns come in pairs, as required by JPEG's subsampled
/// colours: a single last column is omitted.
void LiveCamera::shrink(const GrayFrame& picture, DetectedPicture& out) const {
  out.thumbnail_width_px = picture.width_px / (2 * kShrink) * 2;
  out.thumbnail_height_px = picture.height_px / kShrink;
  const auto stride = static_cast<std::ptrdiff_t>(picture.stride);
  for (int y = 0; y < out.thumbnail_height_px; ++y) {
    for (int x = 0; x < out.thumbnail_width_px; ++x) {
      const std::uint8_t* block = picture.pixels + kShrink * (y * stride + x);
      unsigned sum = 0;
      for (int row = 0; row < kShrink; ++row) {
        for (int column = 0; column < kShrink; ++column) {
          sum += block[row * stride + column];
        }
      }
      out.thumbnail.push_back(static_cast<std::byte>(sum / (kShrink * kShrink)));
    }
  }
}

}  // namespace marey::capture
