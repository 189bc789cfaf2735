// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "capture/video/frame_source.h"
#include "core/base/result.h"

// Private to capture: the only header of the folder that exposes OpenCV.
namespace marey::capture {

/// Opens a video with FFmpeg, before its first frame. `name` is used in messages.
/// Disables the messages of OpenCV and FFmpeg once per program, so that a user sees one
/// sentence. Errors (kBadInput): the video cannot be opened.
[[nodiscard]] Result<cv::VideoCapture> open_capture(const std::filesystem::path& path,
                                                    const std::string& name);

/// Opens a video for reading undecoded frames: each is a row of bytes. Returns nullopt if
/// it cannot be opened.
[[nodiscard]] std::optional<cv::VideoCapture> open_packets(
    const std::filesystem::path& path);

/// Reads an 8-bit image, decoded with the cv::ImreadModes `mode`. `name` is used in
/// messages. Errors (kBadInput): the file cannot be read completely.
[[nodiscard]] Result<cv::Mat> read_image(const std::filesystem::path& path,
                                         int mode,
                                         const std::string& name);

/// Converts BGR or grey to grey, reusing the memory of `gray`.
void to_gray(const cv::Mat& image, cv::Mat& gray);

/// Returns a view of an 8-bit single-channel matrix, which must outlive it.
[[nodiscard]] GrayFrame view_of(const cv::Mat& gray, int index);

/// Returns "1280x720".
[[nodiscard]] std::string size_text(int width_px, int height_px);
[[nodiscard]] inline std::string size_text(const cv::Mat& image) {
  return size_text(image.cols, image.rows);
}

}  // namespace marey::capture
