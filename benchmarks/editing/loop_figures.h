// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>

#include "edit/state/edit_state.h"

#include "core/base/result.h"

namespace marey {

/// Number of copies of the loop that are measured.
inline constexpr int kLoopCycles = 10;

/// Figures of the best loop of one motion. "plain": all joints alike.
struct LoopRow {
  std::string name;
  double period_s = 0.0;
  /// Mean time between two strikes of one foot around the middle of the loop.
  std::optional<double> strikes_s;
  double change_percent = 0.0;
  /// Joints at the ends of the cycle before correction.
  double gap_mm = 0.0, plain_mm = 0.0, worst_mm = 0.0, median_mm = 0.0;
  double velocity_gap = 0.0, plain_velocity_gap = 0.0;
  double turn_deg = 0.0, travel_m = 0.0;
  /// Largest of all joints at the seam, and 95th percentile of all other frames: the
  /// cycle as cut and after correction. [m/s^2]
  double cut_acceleration = 0.0, cut_inside = 0.0;
  double seam_acceleration = 0.0, inside_acceleration = 0.0;
  /// Velocity before against after a frame, by cubics through four frames. [m/s]
  double seam_jump = 0.0, inside_jump = 0.0;
  /// Mean speed of bearing joints [cm/s]; copies against the first one moved by whole
  /// travels.
  double slide_source = 0.0, slide_loop = 0.0, drift_m = 0.0, displaced_mm = 0.0;
  double find_ms = 0.0, all_ms = 0.0;
};

/// Measures the loop of apply_cyclify(), straight, kLoopCycles copies. Errors: its.
[[nodiscard]] Result<LoopRow> measure_loop(const std::string& name,
                                           const edit::EditState& state);

}  // namespace marey
