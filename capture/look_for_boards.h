// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/board.h"

namespace marey::capture {

/// What a recording shows in place of the target that was looked for.
struct SeenInstead {
  std::string what;    ///< "markers 0 to 9 of DICT_4X4_50 are": it follows "but".
  std::string remedy;  ///< What to change in session.toml, or what to record.
};

/// Looks at eight frames of a video or folder for boards other than `target`, which was
/// not found there: markers of any of OpenCV's dictionaries, white on black and mirrored
/// too, Kalibr's tags, chessboards of any size. nullopt when there is none of them, or
/// the recording cannot be read. Ten seconds.
[[nodiscard]] std::optional<SeenInstead> look_for_boards(
    const std::filesystem::path& path, const CalibrationTarget& target);

}  // namespace marey::capture
