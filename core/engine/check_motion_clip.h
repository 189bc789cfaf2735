// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/engine/motion_clip.h"

namespace marey {

/// Returns the reason why a clip cannot be played: no name; a rate or leg length that is
/// not positive and finite; fewer than two frames or another number of path entries;
/// numbers that are not finite or above 1e6; rotations that are not of unit length;
/// contacts that do not ascend or are outside of the clip. nullopt: it can. Linear in
/// frames.
[[nodiscard]] std::optional<std::string> motion_clip_fault(const MotionClip& clip);

}  // namespace marey
