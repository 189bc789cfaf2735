// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "capture/detect_videos.h"
#include "capture/look_for_boards.h"
#include "core/board.h"

namespace marey::capture {

/// Looks for the target itself, which was not found in `searched` frames of a recording
/// (all of them where there is no such range), in two dozen frames from all over it: in
/// the frames that were not searched; an AprilGrid in the picture's mirror image, or of
/// another family than `family`. `what` follows "but". nullopt when it is in none of
/// these, or the recording cannot be read. Precondition: the target is a board. Cost:
/// reads the recording, and some five seconds where nothing is found.
[[nodiscard]] std::optional<SeenInstead> look_elsewhere(
    const std::filesystem::path& path,
    const CalibrationTarget& target,
    const std::string& family,
    const std::optional<FrameRange>& searched);

}  // namespace marey::capture
