// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "capture/frame_source.h"

namespace marey::capture {

/// The frames of a video file, decoded by FFmpeg one at a time: memory does not grow with
/// the video. A frame's index is the count of frames before it, never the container's
/// time stamp, which several containers keep badly. info() repeats the container's rate,
/// size (after its rotation mark) and promised number of frames.
///
/// Of motion JPEG, as cameras record it (not in MP4), a frame that is damaged is said to
/// be (GrayFrame::damaged), and the next is read as ever. Other codecs hide it.
///
/// Errors (kBadInput): an empty file; not a video that FFmpeg can open; while reading, a
/// picture that changes its size; a video of nothing but damaged frames; a video that
/// ends before the frames that its header promises. An MP4 that was trimmed by an edit
/// list promises only what is left; other containers promise to within 2 frames or 2 %.
/// Precondition: `path` is a file. FFmpeg prints nothing unless the environment variable
/// OPENCV_FFMPEG_LOGLEVEL asks for it.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_video_file(
    const std::filesystem::path& path, std::string name);

}  // namespace marey::capture
