// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/markers/marker_state.h"

namespace marey::edit {

/// Moves and turns all markers as a rigid body about the vertical. The place of the
/// recording at an instant is the mean of the markers that are seen there. Its direction
/// of travel is that of the mean of the markers that are seen at both ends of the span.
/// Linear in samples.
///
/// Figures: turn_deg, moved_m, markers_used (for the place). Errors (bad input): neither
/// position nor heading; no marker is seen at `at`; for a heading: fewer than half of the
/// markers of either end are seen at both, or they travel less than 0.3 m; groups or
/// blend_s; those of resolve_moment().
[[nodiscard]] Result<MarkerState> place_markers(const PlaceOp& op,
                                                const MarkerOpContext& context,
                                                const MarkerState& state,
                                                OpReport& report);

}  // namespace marey::edit
