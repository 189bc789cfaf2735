// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/planar_match.h"

#include "core/motion.h"

namespace marey::edit {

/// A synthetic walk of which period and travel are known.
struct VariedWalk {
  Motion motion;
  double period_s = 0.0;
  PlanarMove travel;  ///< Moves each posture to the one a period later, without noise.
};

struct VariedWalkOptions {
  double duration_s = 5.0;
  double hz = 60.0;
  double period_s = 1.1;
  double turn_rad = 0.0;  ///< Per cycle.
  double heading_rad = 0.0;
  double noise_rad = 0.0;
  double noise_m = 0.0;
  double growth_per_s = 0.0;  ///< The arms swing further and the body rises.
  unsigned seed = 1;
};

/// Makes the walk of tests/support/simulation/synthetic_walk.h with swinging arms,
/// another cadence and a path that turns at constant speed.
[[nodiscard]] VariedWalk varied_walk(const VariedWalkOptions& options = {});

/// Returns options by seed: rates 30, 60 and 120 Hz, periods of 0.8 to 1.4 s, turns of up
/// to 10 degrees per cycle.
[[nodiscard]] VariedWalkOptions random_walk_options(unsigned seed);

}  // namespace marey::edit
