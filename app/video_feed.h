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

#include "app/frame_feed.h"
#include "capture/frame_source.h"
#include "core/result.h"

namespace marey::app {

/// What of a video is to be seen.
struct VideoPart {
  std::filesystem::path path;       ///< A video or a folder of images.
  int first_frame = 0;              ///< Frames before it are passed over.
  std::optional<int> last_frame{};  ///< Inclusive; nullopt: to the end.
};

struct VideoFeedOptions {
  std::string name;                     ///< Of the camera, in messages.
  std::filesystem::path path;           ///< These three as in VideoPart.
  int first_frame = 0;
  std::optional<int> last_frame{};
  std::vector<VideoPart> then{};        ///< What follows, of pictures of the same size.
  std::optional<FrameRate> rate{};      ///< nullopt: as the video says.
  bool loop = false;                    ///< From the last frame on to the first.
  int buffers = 4;                      ///< Frames that wait for the reader, as a driver's.
};

/// A recorded video as a camera: its frames come at their pace, each at its instant of
/// CLOCK_MONOTONIC, grey, decoded ahead of time by a thread of its own, which gives way to
/// those that work on pictures, as a camera would not disturb them. As a camera does, it
/// drops and counts what nobody fetched in time: the oldest of more than `buffers`. Where
/// decoding cannot keep the pace, frames come late and keep their instants.
class VideoFeed final : public FrameFeed {
 public:
  /// Opens the videos and decodes the first frame. Errors: open_frames()'s; a rate that
  /// nobody knows; pictures of another size in what follows (kBadInput).
  [[nodiscard]] static Result<std::unique_ptr<VideoFeed>> open(
      const VideoFeedOptions& options);
  ~VideoFeed() override;

  /// The first frame's instant. Cameras of one rig begin at one. Before it is called,
  /// next() has no frames.
  void begin_at(Timestamp begin);

  std::optional<capture::RawFrame> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] const capture::DeviceSettings& settings() const override {
    return settings_;
  }
  [[nodiscard]] std::string device() const override;
  [[nodiscard]] std::vector<FeedEvent> events() override;
  [[nodiscard]] bool is_over() override;
  /// Lost, and why, once a picture or a following video could not be read: none comes
  /// after those that were decoded before.
  [[nodiscard]] FeedHealth health() const override;

 private:
  struct Picture {
    std::int64_t number = 0;  ///< Counted over all rounds of a loop.
    std::vector<std::byte> pixels;
  };

  VideoFeed(const VideoFeedOptions& options,
            std::vector<VideoPart> parts,
            std::unique_ptr<capture::FrameSource> source,
            FrameRate rate);
  void decode(const std::stop_token& stop);
  [[nodiscard]] Status seek_first();
  [[nodiscard]] Result<bool> decode_next(Picture& picture);
  [[nodiscard]] Result<bool> decode_one(Picture& picture);
  [[nodiscard]] Timestamp due(std::int64_t number) const;
  void drop_stale(Timestamp now);
  [[nodiscard]] capture::RawFrame lend_first();

  const VideoFeedOptions options_;
  capture::DeviceSettings settings_;
  FrameRate rate_;
  // Of the thread that decodes.
  std::unique_ptr<capture::FrameSource> source_;
  const std::vector<VideoPart> parts_;  ///< At least one.
  std::size_t part_ = 0;
  int next_in_file_ = 0;
  std::int64_t next_number_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Picture> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;  ///< With the one that is lent.
  bool lent_ = false;
  bool ended_ = false;
  std::optional<Timestamp> begin_;
  std::int64_t last_handed_out_ = -1;
  std::vector<FeedEvent> events_;
  FeedHealth health_;
  std::jthread decoder_;  ///< Last: it ends before what it uses.
};

}  // namespace marey::app
