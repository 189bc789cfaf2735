// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "capture/search/alternative_target.h"
#include "capture/search/camera_input.h"
#include "core/board.h"
#include "core/tag_family.h"

namespace marey::capture {

/// A board other than the target of a trial, detected in a few frames.
struct OtherBoard {
  std::size_t input = 0;  ///< Index of the recording that shows it.
  int frames = 0;         ///< Number of frames searched in this recording.
  AlternativeTarget seen;
};

/// Searches frames sampled from each recording of a trial (24 in all, or six each) for
/// other boards, before all frames are searched. Returns nullopt if any frame shows the
/// target, or none shows another board. Cost: the search of one or two frames if the
/// target is there, otherwise a few seconds. Precondition: the target has points.
[[nodiscard]] std::optional<OtherBoard> detect_wrong_board(
    std::span<const CameraInput> inputs,
    const CalibrationTarget& target,
    std::span<const TagFamilyUse> worn = {});

}  // namespace marey::capture
