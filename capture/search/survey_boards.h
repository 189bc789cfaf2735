// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "capture/search/alternative_target.h"
#include "core/board.h"
#include "core/tag_family.h"

namespace marey::capture {

/// Searches eight frames of a video or folder for boards other than `target`, which was
/// not found there: markers of any of OpenCV's dictionaries, also white on black and
/// mirrored, Kalibr's tags, and chessboards of any size. Tags on bodies (`worn`) are
/// ignored. Returns nullopt if there is no such board, or the recording cannot be read.
/// Cost: at most ten seconds.
[[nodiscard]] std::optional<AlternativeTarget> survey_boards(
    const std::filesystem::path& path,
    const CalibrationTarget& target,
    std::span<const TagFamilyUse> worn = {});

}  // namespace marey::capture
