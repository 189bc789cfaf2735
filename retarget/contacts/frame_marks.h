// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/human/contacts.h"

namespace marey::retarget {

/// Returns 1 for each frame that lies in one of the runs, else 0. Linear in frames.
/// Precondition: runs lie within 0 to count - 1.
[[nodiscard]] inline std::vector<char> frame_marks(std::span<const FrameRange> runs,
                                                   std::size_t count) {
  std::vector<char> on(count, 0);
  for (const FrameRange& run : runs) {
    MAREY_ASSERT(run.first >= 0 && run.last < static_cast<int>(count));
    std::fill(on.begin() + run.first, on.begin() + run.last + 1, char{1});
  }
  return on;
}

/// Inverse of frame_marks(): returns the runs of frames with this value, ascending.
/// Linear in frames.
[[nodiscard]] inline std::vector<FrameRange> runs_with(std::span<const char> marks,
                                                       char value = 1) {
  std::vector<FrameRange> out;
  for (int frame = 0; frame < static_cast<int>(marks.size()); ++frame) {
    if (marks[static_cast<std::size_t>(frame)] != value) continue;
    if (!out.empty() && out.back().last == frame - 1) {
      out.back().last = frame;
    } else {
      out.push_back({frame, frame});
    }
  }
  return out;
}

}  // namespace marey::retarget
