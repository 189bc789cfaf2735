// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/models/steer_moves.h"

namespace marey::engine {

struct SteerForecast {
  bool arrives = false;
  int steps = 0;  ///< Landings.
  double duration_s = 0.0;
  double distance_m = 0.0;
  double missing_m = 0.0;
};

/// Predicts the course from this step on.
[[nodiscard]] SteerForecast forecast(const SteerScene& scene,
                                     const SteerMoment& moment,
                                     const SteerStrategy& strategy);

/// Returns the strategy that arrives first, with its forecast; if none arrives, the
/// direct one.
[[nodiscard]] SteerStrategy best_strategy(const SteerScene& scene,
                                          const SteerMoment& moment,
                                          SteerForecast& predicted);

}  // namespace marey::engine
