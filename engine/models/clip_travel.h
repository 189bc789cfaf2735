// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/sync/phases.h"

#include "core/base/result.h"
#include "core/engine/motion_clip.h"

namespace marey::engine {

/// One step of a clip: one foot stands alone, then the next foot lands. Displacements are
/// those of the hips since the landing before, in the frame of the travel direction at
/// that landing: `along` it, and `across` it towards greater headings (left if the body
/// faces its travel).
struct ClipStep {
  PhaseClass stands = PhaseClass::kLeft;  ///< kLeft or kRight.
  double alone_start_s =
      0.0;                   ///< One foot alone bears from here; clip time in [0, cycle).
  double alone_end_s = 0.0;  ///< To here; may exceed the cycle.
  double land_s = 0.0;       ///< The next foot lands: >= alone_end_s.
  double along_legs = 0.0;
  double across_legs = 0.0;
  double length_legs = 0.0;  ///< For the displacement.
  /// Share of the displacement at which the hips pass the standing foot, about.
  double passes_at = 0.5;
  double turn_rad = 0.0;  ///< Change of the travel direction since the landing before.
  /// Sums over the steps from the first of the cycle to this one.
  double sum_along_legs = 0.0;
  double sum_across_legs = 0.0;
};

/// Travel of a clip that loops. Its cycle is the whole loop: a drunk's single steps say
/// nothing about the direction in which he travels.
struct ClipTravel {
  double cycle_s = 0.0;
  double distance_legs = 0.0;  ///< Displacement of the hips over a cycle.
  /// Direction of that displacement relative to the mean heading of the cycle; 0 if the
  /// clip does not travel.
  double direction_rad = 0.0;
  double turn_rad = 0.0;        ///< Heading gained over a cycle.
  double speed_legs_s = 0.0;    ///< Mean: distance_legs / cycle_s.
  double mean_step_legs = 0.0;  ///< For ClipStep::length_legs.
  double mean_alone_s = 0.0;    ///< Time in which one foot stands alone, of a step.
  /// True if the clip leads anywhere: the displacement over a cycle is more than 0.15
  /// of the sum of its steps' lengths. Otherwise (a dance on the spot) it has no
  /// direction.
  bool travels = false;
  /// Every step leads along the travel by 0.5 to 1.5 of the mean.
  bool is_even = false;
  std::vector<ClipStep> steps;  ///< Ascending by landing; at least one.
};

/// Computes the travel of a clip from its path and contacts. Linear in its frames.
/// Errors (bad input, naming the clip): it does not loop; it has no contacts; no foot
/// ever stands alone.
[[nodiscard]] Result<ClipTravel> travel_of_clip(const MotionClip& clip);

/// Returns the direction in which a clip travels at a time, relative to its heading at
/// that time: that of the displacement over the cycle before. 0 if it does not travel.
[[nodiscard]] double travel_direction(const MotionClip& clip,
                                      const ClipTravel& travel,
                                      double clip_s);

}  // namespace marey::engine
