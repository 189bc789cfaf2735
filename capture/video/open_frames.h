// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "capture/video/frame_source.h"
#include "core/base/result.h"

namespace marey::capture {

enum class RecordingKind { kVideoFile, kImageFolder };

/// Returns the kind of recording at `path`: a folder, or a pattern of names, means
/// images. Errors (kBadInput): the path does not exist. `name` is used in messages.
[[nodiscard]] Result<RecordingKind> recording_kind(const std::filesystem::path& path,
                                                   const std::string& name);

/// Opens the video file or folder of images at `path`. `name` is used in messages; the
/// path if it is empty. Errors as for recording_kind(), open_video_file() and
/// open_image_folder().
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_frames(
    const std::filesystem::path& path, std::string name = {});

}  // namespace marey::capture
