// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/motion.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/measure_departure.h"

namespace marey::app {

/// Angle between trunk and source above which the trunk counts as far from its source.
inline constexpr double kFarTrunk_deg = 30.0;
/// Gate (exit code 4): the trunk is beyond kMaxTrunk_deg, while without balance the same
/// constraints are met with the trunk within kNearTrunk_deg of its source.
inline constexpr double kMaxTrunk_deg = 45.0;
inline constexpr double kNearTrunk_deg = 10.0;

/// Differences between the postures of a run and those of its source.
struct AdaptDeparture {
  std::vector<retarget::SegmentDeparture> segments;  ///< One per joint.
  /// Hips, spine, neck and head, without constrained joints; per frame.
  /// Empty: constraints control all of them.
  std::vector<retarget::FrameDeparture> trunk;
  int worst_frame = 0;  ///< Index into `trunk`.
  int far_frames = 0;   ///< Number of frames in which the trunk is far from its source.
  /// Number of far frames in which balance alone is the cause: without balance the trunk
  /// stays near its source, and every constraint met with balance is met. And the worst
  /// of these frames; nullopt: none.
  int needless_frames = 0;
  std::optional<int> worst_needless_frame{};
};

/// Measures the departure of `adapted` from `source`.
[[nodiscard]] AdaptDeparture measure_adapt_departure(const Motion& source,
                                                     const Motion& adapted,
                                                     const ConstraintSet& constraints);

/// Compares the frames that are far from their source with the result without balance.
/// Precondition: `without` has the same source and constraints.
void compare_without_balance(const Motion& source,
                             const retarget::AdaptedMotion& with,
                             const retarget::AdaptedMotion& without,
                             AdaptDeparture& departure);

/// Returns the figures for `--json`. Precondition: `motion` is the measured motion.
[[nodiscard]] nlohmann::ordered_json departure_json(const AdaptDeparture& departure,
                                                    const Motion& motion);

/// Returns ", trunk up to 12 degrees from its source"; empty if no trunk was measured.
[[nodiscard]] std::string departure_summary(const AdaptDeparture& departure);

/// Returns the text of the warning or of the gate; empty: the trunk is far in no frame.
[[nodiscard]] std::string departure_text(const AdaptDeparture& departure,
                                         const Motion& motion);

/// Returns true if the gate fails.
[[nodiscard]] bool is_needlessly_far(const AdaptDeparture& departure);

}  // namespace marey::app
