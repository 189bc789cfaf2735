// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

namespace marey::library {

/// Measures how feet stand on the floor Y = 0: "slide_cm_s", "drift_mm", "float_mm"
/// and "sink_mm".
///
/// - slide_cm_s: a ball is low within 2 cm of the 5 % quantile of its heights. The
///   25 % quantile, over frames with a low ball, of the level speed of the slower one, in
///   steps of 1/60 s or one frame. [cm/s]
/// - drift_mm: maximum level distance of a heel or ball from its place at the start of
///   its contact. [mm]
/// - float_mm: 5 % quantile of the height of the lower sole in frames with a contact; 0
///   if it is below the floor. [mm]
/// - sink_mm: 1 % quantile of the height of the lower sole below the floor. [mm]
///
/// Linear in frames. Precondition: no contacts, or one entry per frame.
[[nodiscard]] std::array<FoundFigure, 4> measure_feet_on_floor(
    const QualityFrames& frames,
    const std::vector<FootParts>& contacts,
    const QualityLimits& limits);

}  // namespace marey::library
