// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_limits.h"

#include "core/library/library_motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Measures a solved motion's own uncertainty at the 12 limb joints: "gap_share",
/// "longest_gap_s" and "sigma_p95_mm". 0 without uncertainty.
///
/// - gap_share: share of inferred joints (Source::kInferred) in all frames.
/// - longest_gap_s: longest run of frames in which one joint is inferred. [s]
/// - sigma_p95_mm: 95 % quantile of JointUncertainty::sigma_m. [mm]
///
/// Linear in frames. Precondition: no uncertainty, or one entry per frame and joint.
[[nodiscard]] std::array<FoundFigure, 3> measure_certainty(const LibraryMotion& clip,
                                                           const retarget::BodyMap& map,
                                                           const QualityLimits& limits);

}  // namespace marey::library
