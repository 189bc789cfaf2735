// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace marey::recordings {

// Limits of the motion data of external files. Values beyond them are mistakes that would
// overflow later, or attempts of small files to use up all memory.

/// Maximum distance of a joint from its parent, and of any position from the origin. [m]
inline constexpr double kMaxDistance_m = 1e4;
/// Maximum angle of a rotation in a file: a thousand turns. Programs that unroll angles
/// write large ones; beyond this limit only rounding errors remain of the angle modulo a
/// turn.
inline constexpr double kMaxTurned_deg = 360e3;

inline constexpr double kMinRateHz = 0.1;
inline constexpr double kMaxRateHz = 2000.0;
/// Animations of glTF with slower keys are meant to be interpolated: they are read at
/// kBlendedKeysHz.
inline constexpr double kMinKeysHz = 10.0;
inline constexpr double kBlendedKeysHz = 30.0;

/// Maximum number of joints between a root and its farthest descendant. Programs that go
/// down a skeleton recursively, and the indented text of a BVH, need a limit.
inline constexpr std::size_t kMaxSkeletonDepth = 1000;
/// Maximum number of joints of a skeleton; the largest known avatars have some thousands.
inline constexpr std::size_t kMaxJoints = 30'000;

/// Returns true if a motion holds more rotations than is allowed for a file of `numbers`
/// numbers: an hour of a whole body at 120 Hz (some 600 MB), or one rotation per number.
[[nodiscard]] inline bool too_many_rotations(std::size_t joints,
                                             std::size_t frames,
                                             std::size_t numbers) {
  constexpr std::size_t kMax = 20'000'000;
  return joints > 0 && frames > std::max(kMax, numbers) / joints;
}

}  // namespace marey::recordings
