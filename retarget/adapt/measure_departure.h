// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/motion.h"

namespace marey::retarget {

/// Angle in the world between a segment of an adapted motion and the same segment of its
/// source.
struct SegmentDeparture {
  JointIndex joint{};
  double mean_rad = 0.0;   ///< Over all frames.
  double worst_rad = 0.0;  ///< Maximum over the frames.
  int worst_frame = 0;     ///< Index of that frame in the motion's poses.
};

/// Returns the departure of every segment of `adapted` from `source`, one per joint.
/// Precondition: both motions have the same skeleton and the same number of poses.
[[nodiscard]] std::vector<SegmentDeparture> measure_departure(const Motion& source,
                                                              const Motion& adapted);

/// The segment of one frame with the largest departure.
struct FrameDeparture {
  JointIndex joint{};
  double rad = 0.0;
};

/// Returns the largest departure among `joints` for each frame. Precondition: as
/// measure_departure(); `joints` is not empty.
[[nodiscard]] std::vector<FrameDeparture> furthest_departures(
    const Motion& source, const Motion& adapted, std::span<const JointIndex> joints);

}  // namespace marey::retarget
