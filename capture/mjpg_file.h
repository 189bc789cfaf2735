// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "capture/frame_source.h"

// Private to capture/.
namespace marey::capture {

/// A video whose frames are JPEG pictures, as cameras send them: each is decoded alone,
/// so that one which is damaged is one damaged frame and the count goes on. Faster than
/// open_video_file()'s other way, since only brightness is decoded. Null when the video
/// is of another kind or cannot be opened.
///
/// Errors while reading (kBadInput): a picture of another size; a video that ends before
/// it should; nothing but damaged frames.
[[nodiscard]] std::unique_ptr<FrameSource> open_mjpg_file(
    const std::filesystem::path& path, const std::string& name);

}  // namespace marey::capture
