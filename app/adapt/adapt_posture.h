// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/floor.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::app {

// Whether the postures that leave `marey adapt` are a body's, whatever constraints are met.

/// A trunk that is further from upright than this is upside down, where its source is
/// upright by kUprightTrunk_deg and the two are kTurnedTrunk_deg apart: exit code 4.
inline constexpr double kUpsideDown_deg = 115.0;
inline constexpr double kUprightTrunk_deg = 90.0;
inline constexpr double kTurnedTrunk_deg = 60.0;
/// A joint below the floor, deeper than the source's deepest joint in that frame: a
/// warning and exit code 4. [mm]
inline constexpr double kDeepJoint_mm = 10.0;
inline constexpr double kPoorJoint_mm = 50.0;

struct AdaptPosture {
  /// Of the line from mid-hip to neck (head) against the vertical, where the source's
  /// trunk is upright: the largest, and the source's there. [deg]
  double trunk_tilt_deg = 0.0;
  double source_tilt_deg = 0.0;
  int tilt_frame = -1;  ///< -1: no trunk.
  int upside_down_frames = 0;
  /// The deepest joint below the floor, beyond the source's deepest joint. [mm]
  double depth_mm = 0.0;
  JointIndex joint{};
  int depth_frame = -1;  ///< -1: none is.
};

/// The floor that a motion stands on: `floor`'s heights are from `height_m`.
struct StandingFloor {
  const Floor& floor;
  double height_m = 0.0;
};

/// Measures by the places of joints that are bones. Linear in frames times joints.
/// Precondition: both motions are of the body of `map`, with as many frames.
[[nodiscard]] AdaptPosture measure_adapt_posture(const Motion& source,
                                                 const Motion& adapted,
                                                 const retarget::BodyMap& map,
                                                 const StandingFloor& floor);

/// The figures for `--json`.
[[nodiscard]] nlohmann::ordered_json posture_figures(const AdaptPosture& posture,
                                                     const Motion& motion);

/// What is wrong with the postures: of kQuality beyond the gate (`is_poor`), else for a
/// warning. Names frame, time and the constraints that are active there.
struct PostureProblem {
  Error error;
  bool is_poor = false;
};
[[nodiscard]] std::optional<PostureProblem> posture_problem(
    const std::string& where,
    const AdaptPosture& posture,
    const Motion& motion,
    const ConstraintSet& constraints);

}  // namespace marey::app
