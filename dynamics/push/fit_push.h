// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "dynamics/push/push_ends.h"
#include "dynamics/push/push_reference.h"

namespace marey::dynamics {

struct FitPushOptions {
  /// The body flies before the start, or after the end: the force there is 0.
  bool from_flight = false;
  bool to_flight = false;
  /// Frequency above which the force is smoothed.
  double cutoff_hz = 10.0;
  double gravity_m_s2 = kStandardGravity_m_s2;
  /// A horizontal axis: no gravity, and the force may have any sign.
  bool is_horizontal = false;
};

/// Push fitted to the captured positions of one support.
struct PushFit {
  PushEnds ends;            ///< States of the fitted curve at both ends.
  PushReference reference;  ///< Two samples per given position. Vertical: not negative.
  double rms_m = 0.0;       ///< Distance of the positions from the fitted curve.
};

/// Fits a force to positions of the centre of mass inside one support: a start height, a
/// start velocity and a cubic spline of the force, least squares with a penalty on the
/// force's second derivative. Its gain is 1/2 at `cutoff_hz`. Unlike a smoothed
/// acceleration of the whole motion, the force of an impact is not spread into the flight
/// before it, so the impulse is kept. nullopt: fewer than 8 positions, or a value that is
/// not finite. About 0.1 ms for a push of 1 s.
/// Preconditions: as many times as positions; times ascend and are 0 to `duration_s`,
/// equally spaced; duration_s and cutoff_hz above 0.
[[nodiscard]] std::optional<PushFit> fit_push(std::span<const double> time_s,
                                              std::span<const double> position_m,
                                              double duration_s,
                                              const FitPushOptions& options = {});

}  // namespace marey::dynamics
