// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the share of the errors of tag corners that is constant over
// frames.

#include <span>

#include "core/camera.h"
#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

/// Estimates the share of the variance of corners' errors that all sightings of one tag
/// by one camera have in common: lens, print and light, but also errors of cameras,
/// clocks and skin that the fit does not model. The intraclass correlation of residuals
/// over their declared sigmas, by the analysis of variance (Fisher 1925, 38; Searle,
/// Casella & McCulloch 1992, 3.6), corrected for the part that the fitted tags and
/// lengths absorb. Sightings beyond six medians are left out. At least 0.03, the share of
/// corners of one tag alone (docs/accuracy/README.md, "Simulated sessions"), and at most
/// 1/7, the largest share of moving tags (docs/accuracy/README.md); 1/7 also if there are
/// too few sightings. Precondition: measure(). Some 5 ms.
[[nodiscard]] double estimated_common_share(const SubjectBundle& bundle,
                                            std::span<const Camera> cameras);

}  // namespace marey::reconstruct
