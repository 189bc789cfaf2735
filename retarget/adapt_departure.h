// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/ids.h"
#include "core/motion.h"

namespace marey::retarget {

/// How far one segment is turned in the world from its source.
struct SegmentDeparture {
  JointIndex joint{};
  double mean_rad = 0.0;   ///< Over all frames.
  double worst_rad = 0.0;  ///< In the frame where it is the largest,
  int worst_frame = 0;     ///< of the motion's poses.
};

/// Returns the departure of every segment of `adapted` from `source`, one per joint.
/// Precondition: both are of the same skeleton and have as many poses.
[[nodiscard]] std::vector<SegmentDeparture> measure_departure(const Motion& source,
                                                              const Motion& adapted);

/// The segment of one frame that departs the furthest.
struct FrameDeparture {
  JointIndex joint{};
  double rad = 0.0;
};

/// Returns the largest departure among `joints`, frame by frame.
/// Precondition: as measure_departure(); `joints` is not empty.
[[nodiscard]] std::vector<FrameDeparture> furthest_departures(
    const Motion& source, const Motion& adapted, std::span<const JointIndex> joints);

}  // namespace marey::retarget
