// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "capture/search/alternative_target.h"
#include "capture/search/camera_input.h"
#include "core/base/frame_range.h"
#include "core/board.h"

namespace marey::capture {

/// Searches for the target outside the previous search. It was not found in `searched`
/// frames of a recording (all frames if there is no such range). Samples two dozen frames
/// of the whole recording and searches the frames outside the range, the mirror image
/// (AprilGrid), and families other than `family` (AprilGrid). AlternativeTarget::what is
/// inserted after "but". Returns nullopt if nothing is found, or the recording cannot be
/// read. Precondition: the target is a board. Cost: reads the recording, and some five
/// seconds if nothing is found.
[[nodiscard]] std::optional<AlternativeTarget> find_board_elsewhere(
    const std::filesystem::path& path,
    const CalibrationTarget& target,
    const std::string& family,
    const std::optional<FrameRange>& searched);

}  // namespace marey::capture
