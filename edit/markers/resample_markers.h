// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "edit/markers/marker_state.h"

namespace marey::edit {

/// Returns the markers on another time grid: frame k shows the instant `at_frame[k]` of
/// the state (an index with its fraction). Whole numbers give samples to the bit. Between
/// two frames a marker is interpolated by the natural cubic spline through the run in
/// which it was seen; it is not seen there unless it was seen in both, so gaps stay gaps.
/// Such a sample has the larger sigma, the source that is trusted less, and the cameras
/// that saw it in both frames. Annotations move along (resample_annotations()).
///
/// Consecutive whole frames at the same rate keep their numbers and times on the
/// recording's clock; any other result begins with frame 1 at time 0. Movement faster
/// than half the new rate is not smoothed. Linear in samples.
/// Precondition: `at_frame` ascends strictly within [0, frames - 1]; `rate_hz` > 0.
[[nodiscard]] MarkerState resample_markers(const MarkerState& state,
                                           std::span<const double> at_frame,
                                           double rate_hz);

}  // namespace marey::edit
