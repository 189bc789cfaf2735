// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "capture/detect_videos.h"
#include "core/board.h"
#include "core/tag_family.h"

namespace marey::capture {

/// What a recording shows in place of the target that was looked for.
struct SeenInstead {
  std::string what;    ///< "markers 0 to 9 of DICT_4X4_50 are": it follows "but".
  std::string remedy;  ///< What to change in session.toml, or what to record.
};

/// Looks at eight frames of a video or folder for boards other than `target`, which was
/// not found there: markers of any of OpenCV's dictionaries, white on black and mirrored
/// too, Kalibr's tags, chessboards of any size. Tags that bodies wear (`worn`) are no
/// board. nullopt when there is none of them, or the recording cannot be read. Ten
/// seconds at most.
[[nodiscard]] std::optional<SeenInstead> look_for_boards(
    const std::filesystem::path& path,
    const CalibrationTarget& target,
    std::span<const TagFamilyUse> worn = {});

/// What a trial shows in place of its target, seen in a few frames.
struct OtherBoard {
  std::size_t input = 0;  ///< Which of the recordings shows it.
  int frames = 0;         ///< That were looked at, of this recording.
  SeenInstead seen;
};

/// Looks at some frames from all over each recording of a trial (two dozen in all, or six
/// each), before all of them are searched, and tells what other board is there. nullopt
/// when any frame shows the target, or none shows another board: then only the whole
/// search will tell. Where the target is there, it costs the search of a frame or two;
/// otherwise a few seconds. Precondition: the target has points.
[[nodiscard]] std::optional<OtherBoard> glance_for_other_board(
    std::span<const CameraInput> inputs,
    const CalibrationTarget& target,
    std::span<const TagFamilyUse> worn = {});

}  // namespace marey::capture
