// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dynamics/push/force_push.h"

namespace marey::dynamics {

/// A push made from a seed: falls, lingers or bounces, pushes off and leaves the floor
/// with force 0.
struct MadePush {
  PushReference reference;
  PushEnds ends;  ///< Ends of the reference itself, from height 0.
  double peak_m_s2 = 0.0;
};
[[nodiscard]] MadePush made_push(unsigned seed);

/// Returns ends that differ from the push's own: rise 0.25 to 2 times, end height by up
/// to 4 cm, duration by up to 20 %.
[[nodiscard]] PushEnds changed_ends(const MadePush& made, unsigned seed);

}  // namespace marey::dynamics
