// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/engine/motion_clip.h"

namespace marey::testing {

/// Returns a clip with random postures of unit rotations, a random path, contacts, tags,
/// notes and constraints. The same arguments give the same clip.
[[nodiscard]] MotionClip random_clip(const std::string& name,
                                     std::size_t frames,
                                     std::uint32_t seed);

/// Returns `clips` random clips in the order of their names, of 2 to `max_frames` frames.
/// Precondition: 2 <= max_frames.
[[nodiscard]] MoveSet random_moves(std::size_t clips,
                                   std::size_t max_frames,
                                   std::uint32_t seed);

}  // namespace marey::testing
