// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace marey::recordings {

// What files from elsewhere may say of a moving body. Further out lie mistakes, whose
// numbers overflow later and elsewhere, and small files that ask for all memory.

/// Of a joint from its parent, and of anything from the origin. [m]
inline constexpr double kFurthest_m = 1e4;
/// Largest angle of a rotation in a file: a thousand turns. Programs that unroll angles
/// write some; beyond, what is left of an angle within its last turn is rounding.
inline constexpr double kMostTurned_deg = 360e3;

inline constexpr double kSlowestRateHz = 0.1;
inline constexpr double kFastestRateHz = 2000.0;
/// Animations of glTF with slower keys are meant to be blended: they are read at
/// kBlendedKeysHz.
inline constexpr double kSlowestKeysHz = 10.0;
inline constexpr double kBlendedKeysHz = 30.0;

/// Maximum number of joints between a root and its farthest descendant. Programs that go
/// down a skeleton recursively, and the indented text of a BVH, need a limit.
inline constexpr std::size_t kMaxSkeletonDepth = 1000;
/// Maximum number of joints of a skeleton; the largest known avatars have some thousands.
inline constexpr std::size_t kMaxJoints = 30'000;

/// Whether a motion holds more rotations than a file that says `numbers` numbers may ask
/// for: an hour of a whole body at 120 Hz (some 600 MB), or one for each number.
[[nodiscard]] inline bool too_many_rotations(std::size_t joints,
                                             std::size_t frames,
                                             std::size_t numbers) {
  constexpr std::size_t kMost = 20'000'000;
  return joints > 0 && frames > std::max(kMost, numbers) / joints;
}

}  // namespace marey::recordings
