// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/engine/blend_posture.h"

namespace marey::engine {

/// Maximum number of postures in a blend.
inline constexpr std::size_t kMaxBlended = 8;

/// Side on which each rotation was blended in the step before: keeps weights from
/// flipping a rotation when sources are more than 170 degrees apart.
struct BlendSides {
  BlendPosture::Rotations x{};
  BlendPosture::Rotations y{};
  BlendPosture::Rotations z{};
  BlendPosture::Rotations w{};
  bool is_known = false;
};

}  // namespace marey::engine
