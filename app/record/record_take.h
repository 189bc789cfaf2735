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

/// Whether `folder` has nothing that a recording of these cameras would write over.
/// Errors (kBadInput): there is a recording, or part of one.
[[nodiscard]] Status check_unrecorded(const std::filesystem::path& folder,
                                      std::span<const std::string> cameras);

/// Records all cameras at once, until `stop` says so or the time is over:
/// FOLDER/CAMERA.mkv of each, and FOLDER/take.sqlite. JPEG pictures are kept byte for
/// byte, others are encoded. Each camera has a thread that listens to it and one that
/// writes; a camera or disk that is slow costs others nothing. Frames from before the
/// beginning are not of the take. What is in the files at any moment is at most half a
/// second old, also when this process is killed.
///
/// `progress` counts the frames of all cameras. Errors: those of check_unrecorded(); the
/// folder or files cannot be made; a camera's pictures cannot be recorded; the take's
/// file cannot be written to (kDevice). Where it cannot begin, nothing is left behind. A
/// camera that fails, sends nothing in the last second, or comes back with other pictures
/// is told in its summary, and the others go on.
/// Preconditions: at least one camera; names are those of files, each once.
[[nodiscard]] Result<std::vector<CameraSummary>> record_take(
    std::span<const RecordedCamera> cameras,
    const RecordOptions& options,
    const std::function<bool()>& stop,
    const Progress& progress = {});

}  // namespace marey::app
