// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "capture/frame_source.h"
#include "core/result.h"

// Private to capture/: the only header of the room that shows OpenCV.
namespace marey::capture {

/// A video that FFmpeg can decode, before its first frame. Messages call it `name`.
/// OpenCV's and FFmpeg's own messages are switched off, once for the program: a user
/// should see one sentence. kBadInput when it cannot be opened.
[[nodiscard]] Result<cv::VideoCapture> open_capture(const std::filesystem::path& path,
                                                    const std::string& name);

/// The frames of a video as they are in the file, not decoded: each a row of bytes.
/// nullopt when it cannot be opened.
[[nodiscard]] std::optional<cv::VideoCapture> open_packets(
    const std::filesystem::path& path);

/// An 8-bit image, decoded as cv::ImreadModes `mode` says. Messages call it `name`.
/// kBadInput when it cannot be read to its end.
[[nodiscard]] Result<cv::Mat> read_image(const std::filesystem::path& path,
                                         int mode,
                                         const std::string& name);

/// BGR or already grey to grey, reusing `gray`'s memory.
void to_gray(const cv::Mat& image, cv::Mat& gray);

/// A view of an 8-bit single-channel matrix, which must outlive it.
[[nodiscard]] GrayFrame view_of(const cv::Mat& gray, int index);

/// "1280x720".
[[nodiscard]] std::string size_text(int width_px, int height_px);
[[nodiscard]] inline std::string size_text(const cv::Mat& image) {
  return size_text(image.cols, image.rows);
}

}  // namespace marey::capture
