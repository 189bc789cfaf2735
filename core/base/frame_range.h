// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey {

/// Frames `first` to `last` of a motion, a video or a trial, both included, counted from
/// 0.
struct FrameRange {
  int first = 0;
  int last = 0;
};

}  // namespace marey
