// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: how much of the errors of tag corners is the same frame after
// frame.

#include <span>

#include "core/camera.h"
#include "reconstruct/subject_bundle.h"

namespace marey::reconstruct {

/// Share of the variance of corners' errors that all sightings of one tag by one camera
/// have in common: lens, print and light, but also cameras, clocks and skin that are not
/// quite what the fit takes them for. The intraclass correlation of residuals over their
/// declared sigmas, by the analysis of variance (Fisher 1925, 38; Searle, Casella &
/// McCulloch 1992, 3.6), with what the fitted tags and lengths take up of it counted
/// back. Sightings beyond six medians are left out. Not below 0.03, which corners of one
/// tag have by themselves (docs/measurements.md, "Simulated sessions"), and not above
/// 1/7, the most that moving tags show (docs/measurements.md); that where there are too
/// few sightings to tell. Precondition: measure(). Some 5 ms.
[[nodiscard]] double estimated_common_share(const SubjectBundle& bundle,
                                            std::span<const Camera> cameras);

}  // namespace marey::reconstruct
