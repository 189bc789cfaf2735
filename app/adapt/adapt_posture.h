// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/finding.h"
#include "core/floor.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::app {

// Checks that the postures written by `marey adapt` are plausible for a human body,
// whichever constraints are met.

/// A trunk tilted by more than kUpsideDown_deg from upright is upside down if its source
/// is tilted by less than kUprightTrunk_deg and the two differ by kTurnedTrunk_deg: exit
/// code 4.
inline constexpr double kUpsideDown_deg = 115.0;
inline constexpr double kUprightTrunk_deg = 90.0;
inline constexpr double kTurnedTrunk_deg = 60.0;
/// Depth of a joint below the floor, beyond the source's deepest joint in that frame:
/// limit of the warning and of exit code 4. [mm]
inline constexpr double kDeepJoint_mm = 10.0;
inline constexpr double kPoorJoint_mm = 50.0;

struct AdaptPosture {
  /// Largest angle between the vertical and the line from mid-hip to neck (else head),
  /// over the frames whose source has an upright trunk; and the source's angle there.
  /// [deg]
  double trunk_tilt_deg = 0.0;
  double source_tilt_deg = 0.0;
  std::optional<int> tilt_frame;  ///< nullopt: the body has no trunk.
  int upside_down_frames = 0;
  /// Depth of the deepest joint below the floor, beyond the source's deepest joint. [mm]
  double depth_mm = 0.0;
  JointIndex joint{};
  std::optional<int> depth_frame;  ///< nullopt: no joint is below the floor.
};

/// The floor of a motion. Heights of `floor` are relative to `height_m`.
struct StandingFloor {
  const Floor& floor;
  double height_m = 0.0;
};

/// Measures the positions of the joints that are bones. Linear in frames times joints.
/// Precondition: both motions are of the body of `map` and have equally many frames.
[[nodiscard]] AdaptPosture measure_adapt_posture(const Motion& source,
                                                 const Motion& adapted,
                                                 const retarget::BodyMap& map,
                                                 const StandingFloor& floor);

/// Returns the figures for `--json`.
[[nodiscard]] nlohmann::ordered_json posture_json(const AdaptPosture& posture,
                                                  const Motion& motion);

/// Returns the worst fault of the postures, with the frame, the time and the constraints
/// that are active there: poor beyond the gate, else fair. nullopt: no fault.
[[nodiscard]] std::optional<Finding> assess_posture(const std::string& where,
                                                    const AdaptPosture& posture,
                                                    const Motion& motion,
                                                    const ConstraintSet& constraints);

}  // namespace marey::app
