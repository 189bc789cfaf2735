// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "capture/video/frame_source.h"

namespace marey::capture {

/// Returns true if the file name is that of MP4 or QuickTime: the containers that count
/// their frames.
[[nodiscard]] bool is_mp4(const std::filesystem::path& path);

/// Opens a video file, decoded by FFmpeg one frame at a time: memory does not grow with
/// the video. A frame's index is the number of frames before it, never the container's
/// time stamp, which is unreliable in several containers. info() has the container's
/// rate, size (after its rotation mark) and number of frames.
///
/// In motion JPEG as recorded by cameras (not in MP4), a damaged frame is marked
/// (GrayFrame::damaged) and reading continues. Other codecs do not report damage.
///
/// Errors (kBadInput): an empty file; not a video that FFmpeg can open; while reading, an
/// image of another size; a video without any undamaged frame; a video that ends before
/// the number of frames in its header. The header of an MP4 with an edit list counts only
/// the remaining frames; other containers are accurate to within 2 frames or 2 %.
/// Precondition: `path` is a file. FFmpeg prints nothing.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_video_file(
    const std::filesystem::path& path, std::string name);

}  // namespace marey::capture
