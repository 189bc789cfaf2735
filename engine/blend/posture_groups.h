// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/edit/body_group.h"
#include "core/engine/blend_posture.h"

namespace marey::engine {

inline constexpr std::size_t kGroupCount = kEditGroups.size();

/// A number for each group of the body, in the order of kEditGroups.
using PerGroup = std::array<float, kGroupCount>;

/// Group of each rotation of a BlendPosture. The hips' rotation and height are the
/// root's; abdomen, torso and collar bones the trunk's; neck and head the head's.
[[nodiscard]] const std::array<std::uint8_t, kPostureRotations>& group_of_rotation();

/// Group of each limb (human_limbs() order).
[[nodiscard]] const std::array<std::uint8_t, 4>& group_of_limb();

}  // namespace marey::engine
