// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "capture/video/frame_source.h"

// Private to capture.
namespace marey::capture {

/// Opens a video of JPEG images as cameras record it. Each image is decoded
/// independently: a damaged image is one damaged frame and does not affect the frame
/// numbers. Faster than the other path of open_video_file(), since only brightness is
/// decoded. Returns null if the video has another codec or cannot be opened.
///
/// Errors while reading (kBadInput): an image of another size; a video that ends too
/// early; no undamaged frame.
[[nodiscard]] std::unique_ptr<FrameSource> open_mjpg_file(
    const std::filesystem::path& path, const std::string& name);

}  // namespace marey::capture
