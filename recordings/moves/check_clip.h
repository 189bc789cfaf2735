// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/engine/motion_clip.h"

// Private to recordings/moves.
namespace marey::recordings {

/// Returns the reason why a clip cannot be in a file: that of motion_clip_fault(); a name
/// that is not one line of text, a rate out of range, tags or notes out of order, sums
/// that are not hexadecimal. nullopt: it can. Linear in frames.
[[nodiscard]] std::optional<std::string> clip_problem(const MotionClip& clip);

/// Returns the reason why a layout cannot be in a file: knots that do not ascend from 0
/// to
/// 1. nullopt: it can.
[[nodiscard]] std::optional<std::string> layout_problem(const PostureLayout& layout);

}  // namespace marey::recordings
