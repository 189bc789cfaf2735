// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "engine/feet/foot_hold.h"
#include "engine/step/blend_player.h"

namespace marey::engine {

/// Share of a blend above which a part of a foot begins to bear, and below which it
/// ceases to.
inline constexpr double kBearsAbove = 0.5;
inline constexpr double kBearsUntil = 0.45;

/// Predicts the next landing of a foot (0 left, 1 right) of a blend: the time at which
/// the clips that bear on it get the greater weight, and the ankle's height and velocity
/// then. Clips, warps and fades are known in advance, so a landing into a clip that is
/// still fading in is expected, too: it stands as that clip does, at the clip's distance
/// from the other foot if that one bears. nullopt: it bears already, or not within
/// `within_s` of now. Horizontally the ankle's place is where it would be if the root
/// stayed. Some microseconds; allocates nothing.
[[nodiscard]] std::optional<FootReference::Landing> next_landing(const BlendPlayer& blend,
                                                                 std::size_t side,
                                                                 double time_s,
                                                                 double within_s);

}  // namespace marey::engine
