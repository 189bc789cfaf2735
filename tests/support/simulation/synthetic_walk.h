// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/motion.h"

namespace marey::testing {

/// A walk written down, not captured: every foot stands flat, rolls over its toe joint
/// and swings to the next footprint; the truth is known to the frame.
struct SyntheticWalk {
  Motion motion;  ///< An average adult walks towards +Z, 1.1 s per two steps.
  struct Foot {
    std::vector<char> heel;  ///< Per frame: the ankle rests.
    std::vector<char> ball;  ///< Per frame: the toe joint rests.
  };
  std::array<Foot, 2> feet;  ///< Left, right.
};

/// `frames` frames at `hz`; every joint rotation disturbed by `noise_rad` and the root by
/// `noise_m` per axis (standard deviations, fixed seed). With `fall_m_per_s2`, a foot
/// hovers at the end of its swing, falls with this acceleration in the 30 ms before the
/// strike and is arrested as fast in the 30 ms after it. The left foot strikes at whole
/// cycles of 1.1 s, the right one at halves.
[[nodiscard]] SyntheticWalk synthetic_walk(int frames,
                                           double hz,
                                           double noise_rad = 0.0,
                                           double noise_m = 0.0,
                                           double fall_m_per_s2 = 0.0);

}  // namespace marey::testing
