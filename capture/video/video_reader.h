// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <opencv2/core.hpp>

#include "core/base/result.h"

// Private to capture.
namespace marey::capture {

/// Properties of a video that its container states.
struct VideoFacts {
  int width_px = 0;  ///< Width of the stored pictures, before rotation.
  int height_px = 0;
  double rate_hz = 0.0;  ///< Mean rate of its frames; 0 if it is not known.
  double frames = 0.0;   ///< Number of frames, partly by duration and rate; 0: unknown.
  double duration_s = 0.0;  ///< Duration of the movie by its edit lists; 0: unknown.
  int turned_deg = 0;       ///< Clockwise rotation by the rotation mark: 0 to 359.
};

/// The first video stream of a file, read with libav. Disables the messages of libav once
/// per program, so that a user sees one sentence. Not thread-safe.
class VideoReader {
 public:
  /// Opens a video for its undecoded frames. Returns nullopt if it cannot be opened.
  [[nodiscard]] static std::optional<VideoReader> open_packets(
      const std::filesystem::path& path);

  /// Opens a video for its pictures, decoded by up to 16 threads. `name` is used in
  /// messages. Errors (kBadInput): the video cannot be opened.
  [[nodiscard]] static Result<VideoReader> open_pictures(
      const std::filesystem::path& path, const std::string& name);

  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;
  ~VideoReader();

  [[nodiscard]] const VideoFacts& facts() const;

  /// Returns the bytes of the next frame, valid until the next call; nullopt at the end.
  [[nodiscard]] std::optional<std::span<const std::byte>> next_packet();

  /// Decodes the next picture without converting it. Returns false at the end, and where
  /// the video cannot be decoded. Precondition: from open_pictures().
  [[nodiscard]] bool grab();

  /// Returns the size of the grabbed picture as decoded, before its rotation.
  [[nodiscard]] cv::Size grabbed_size() const;

  /// Returns the grabbed picture in BGR, of the size in facts(), not rotated. Its memory
  /// is valid until the next call. Empty if its pixels cannot be converted. Precondition:
  /// grab() returned true, and grabbed_size() is not smaller than in facts().
  [[nodiscard]] cv::Mat picture();

 private:
  struct Impl;
  explicit VideoReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Rotates a picture clockwise by a multiple of 90 degrees; other angles leave it as is.
void turn(const cv::Mat& picture, int turned_deg, cv::Mat& turned);

}  // namespace marey::capture
