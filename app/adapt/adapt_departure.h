// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/motion.h"
#include "retarget/adapt/adapt_departure.h"
#include "retarget/adapt/adapt_motion.h"

namespace marey::app {

/// A trunk that is turned further than this from its source is far from it.
inline constexpr double kFarTrunk_deg = 30.0;
/// The gate (exit code 4): no further, where the same constraints are met with the trunk
/// within kNearTrunk_deg of its source as soon as balance is left out.
inline constexpr double kMaxTrunk_deg = 45.0;
inline constexpr double kNearTrunk_deg = 10.0;

/// How far the postures of a run are from their source.
struct AdaptDeparture {
  std::vector<retarget::SegmentDeparture> segments;  ///< One per joint.
  /// Of hips, spine, neck and head, as far as no constraint is about one of them; per
  /// frame. Empty: constraints are about all of them.
  std::vector<retarget::FrameDeparture> trunk;
  int worst_frame = 0;  ///< Of `trunk`.
  int far_frames = 0;   ///< In which the trunk is far from its source.
  /// Of them, those in which the trunk stays near its source without balance, and every
  /// constraint that is met with it is met without; and the worst of those. -1: none.
  int needless_frames = 0;
  int worst_needless_frame = -1;
};

/// Measures the departure of `adapted` from `source`.
[[nodiscard]] AdaptDeparture measure_adapt_departure(const Motion& source,
                                                     const Motion& adapted,
                                                     const ConstraintSet& constraints);

/// Compares frames that are far from their source to the answer without balance.
/// Precondition: `without` is of the same source and constraints.
void compare_without_balance(const Motion& source,
                             const retarget::AdaptedMotion& with,
                             const retarget::AdaptedMotion& without,
                             AdaptDeparture& departure);

/// The figures for `--json`. Precondition: `motion` is what was measured.
[[nodiscard]] nlohmann::ordered_json departure_figures(const AdaptDeparture& departure,
                                                       const Motion& motion);

/// ", trunk up to 12 degrees from its source"; empty when no trunk was measured.
[[nodiscard]] std::string departure_summary(const AdaptDeparture& departure);

/// What is warned of, or the gate's text; empty: the trunk is nowhere far.
[[nodiscard]] std::string departure_text(const AdaptDeparture& departure,
                                         const Motion& motion);

/// Whether the gate fails.
[[nodiscard]] bool is_needlessly_far(const AdaptDeparture& departure);

}  // namespace marey::app
