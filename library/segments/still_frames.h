// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "library/quality/quality_frames.h"

#include "core/base/frame_range.h"

namespace marey::library {

/// Returns for each frame whether no marked joint is faster than 5 cm/s in the world: 1
/// or 0. Speeds are over 0.2 s around the frame, less at both ends. Linear in frames.
[[nodiscard]] std::vector<char> still_frames(const QualityFrames& frames);

/// Returns the runs of frames marked with 1 that last `min_s` or longer (the time from
/// the first to the last frame), ascending. Linear.
[[nodiscard]] std::vector<FrameRange> runs_of(const std::vector<char>& marks,
                                              double hz,
                                              double min_s);

}  // namespace marey::library
