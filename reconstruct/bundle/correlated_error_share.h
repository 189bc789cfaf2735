// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the share of the variance of tag corners' errors that is
// correlated between frames.

#include <span>

#include "core/camera.h"
#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

/// Estimates the share of the variance of corners' errors that all sightings of one tag
/// by one camera have in common: errors of lens, print and light, and errors of cameras,
/// clocks and skin that the fit does not model. It is the intraclass correlation of the
/// residuals divided by their sigmas, from an analysis of variance with a cell per tag
/// and camera (Fisher 1925, 38; Searle, Casella & McCulloch 1992, 3.6), corrected for the
/// degrees of freedom of the fitted tags and lengths. Sightings with a corner beyond six
/// median residuals are left out.
///
/// Returns a value from 0.01 (simulated corners without errors of cameras) to 1/7 (the
/// largest share of moving tags); 1/7 if there are too few sightings for an estimate.
/// Deterministic. Some 5 ms. Precondition: measure() has set `bundle.median_px`.
[[nodiscard]] double estimate_correlated_error_share(const SubjectBundle& bundle,
                                                     std::span<const Camera> cameras);

}  // namespace marey::reconstruct
