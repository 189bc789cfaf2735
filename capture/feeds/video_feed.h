// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "capture/feeds/frame_feed.h"
#include "capture/video/frame_source.h"
#include "core/base/result.h"

namespace marey::capture {

/// A range of frames of a recording.
struct VideoPart {
  std::filesystem::path path;       ///< A video or a folder of images.
  int first_frame = 0;              ///< Frames before it are skipped.
  std::optional<int> last_frame{};  ///< Inclusive; nullopt: to the end.
};

struct VideoFeedOptions {
  std::string name;            ///< Name of the camera in messages.
  std::filesystem::path path;  ///< First recording: a video or a folder of images.
  int first_frame = 0;         ///< Frames of it before this one are skipped.
  std::optional<int>
      last_frame{};  ///< The last frame of it, inclusive; nullopt: to the end.
  /// Recordings that are played after it, with images of the same size.
  std::vector<VideoPart> then{};
  std::optional<FrameRate> rate{};  ///< nullopt: the rate of the video.
  bool loop = false;                ///< Restart from the first frame after the last.
  int buffers = 4;                  ///< Capacity of the frame queue, like a driver's.
};

/// Plays a recorded video as a camera: frames arrive in real time, each at its instant of
/// CLOCK_MONOTONIC, in grey. A separate thread of low priority decodes them ahead of
/// time, so that it does not slow down the processing. Like a camera, it drops and counts
/// frames that were not fetched in time: the oldest of more than `buffers`. If decoding
/// is too slow, frames arrive late and keep their time stamps.
class VideoFeed final : public FrameFeed {
 public:
  /// Opens the videos and decodes the first frame. Errors (kBadInput): those of
  /// open_frames(); an unknown frame rate; a following recording with another image size.
  [[nodiscard]] static Result<std::unique_ptr<VideoFeed>> open(
      const VideoFeedOptions& options);
  ~VideoFeed() override;

  /// Sets the first frame's instant; it is common to all cameras of a rig. Before this
  /// call, next() returns no frames.
  void begin_at(Timestamp begin);

  std::optional<RawFrame> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] const DeviceSettings& settings() const override { return settings_; }
  [[nodiscard]] std::string device() const override;
  [[nodiscard]] std::vector<FeedEvent> events() override;
  [[nodiscard]] bool is_over() override;
  /// Returns the state lost, with the reason, after an image or a following video could
  /// not be read. Frames decoded before are still returned.
  [[nodiscard]] FeedHealth health() const override;

 private:
  struct Picture {
    std::int64_t number = 0;  ///< Counted over all rounds of a loop.
    std::vector<std::byte> pixels;
  };

  VideoFeed(const VideoFeedOptions& options,
            std::vector<VideoPart> parts,
            std::unique_ptr<FrameSource> source,
            FrameRate rate);
  void decode(const std::stop_token& stop);
  [[nodiscard]] Status seek_first();
  [[nodiscard]] Result<bool> decode_next(Picture& picture);
  [[nodiscard]] Result<bool> decode_one(Picture& picture);
  [[nodiscard]] Timestamp due(std::int64_t number) const;
  void drop_stale(Timestamp now);
  [[nodiscard]] RawFrame acquire_buffer();

  const VideoFeedOptions options_;
  DeviceSettings settings_;
  FrameRate rate_;
  // Used by the decoder thread.
  std::unique_ptr<FrameSource> source_;
  const std::vector<VideoPart> parts_;  ///< At least one.
  std::size_t part_ = 0;
  int next_in_file_ = 0;
  std::int64_t next_number_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Picture> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;  ///< Including the one in use by the reader.
  bool is_acquired_ = false;
  bool ended_ = false;
  std::optional<Timestamp> begin_;
  std::int64_t last_handed_out_ = -1;
  std::vector<FeedEvent> events_;
  FeedHealth health_;
  /// Last member: joined before the members that it uses are destroyed.
  std::jthread decoder_;
};

}  // namespace marey::capture
