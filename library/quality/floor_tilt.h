// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

#include "core/library/library_motion.h"

namespace marey::library {

/// Measures "tilt_deg", the slope of the floor: the root of the sum of the squares of two
/// angles, since the first one shows the slope across a standing body only. [deg]
///
/// - That of a plane through the places at which heels and balls are slower than 0.3 leg
///   lengths per second, at any height, with own heights for heels and balls. The fit is
///   robust against raised feet. Three standard errors are subtracted, with an error of
///   0.6 mm or more in each place, feet of different heights if they move, and slopes of
///   5 % before any measurement.
/// - The lean of a body that stands on both feet half of the time: soles and centre of
///   mass must lean the same way, forward or backward, and the smaller angle counts.
///
/// Linear in frames. Precondition: no contacts, or one entry per frame.
[[nodiscard]] FoundFigure measure_tilt(const QualityFrames& frames,
                                       const std::vector<FootParts>& contacts,
                                       const QualityLimits& limits);

}  // namespace marey::library
