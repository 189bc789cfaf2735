// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/record/record_options.h"
#include "core/base/progress.h"
#include "core/base/result.h"

namespace marey::app {

/// Checks that a recording of these cameras overwrites no file in `folder`. Errors
/// (kBadInput): the first file of a recording, or of a part of one.
[[nodiscard]] Status check_unrecorded(const std::filesystem::path& folder,
                                      std::span<const std::string> cameras);

/// Records all cameras at the same time, until `stop` returns true or the duration is
/// over. Writes FOLDER/CAMERA.mkv for each camera, and FOLDER/take.sqlite. JPEG pictures
/// are stored unchanged, others are encoded. Each camera has one thread that receives
/// frames and one that writes them, so a slow camera or disk does not delay other
/// cameras. Frames from before the start are discarded. The files are at most half a
/// second behind, also if this process is killed.
///
/// `progress` counts the frames of all cameras. Errors: those of check_unrecorded(); the
/// folder or files cannot be created; the pictures of a camera cannot be recorded; the
/// file of the take cannot be written (kDevice). If the recording cannot begin, no files
/// remain. If a camera fails, sends no frame in the last second, or returns with another
/// picture format, its summary has the error, and the others continue.
/// Preconditions: at least one camera; the names are different and valid file names.
[[nodiscard]] Result<std::vector<CameraSummary>> record_take(
    std::span<const RecordedCamera> cameras,
    const RecordOptions& options,
    const std::function<bool()>& stop,
    const Progress& progress = {});

}  // namespace marey::app
