// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

namespace marey::library {

/// Measures deviations of joints from smooth paths: "spike", "jitter_mm" and "cut". They
/// are differences of a high order, which smooth motion hardly contains: at 30 Hz those
/// of the fourth order are as large in a run as the noise of 1 mm.
///
/// - spike: e(t) is the sixth difference of a joint's positions over 20, so that a single
///   displaced position counts in full; maximum of |e| / (8 mm + 2 m), with m the median
///   of |e| over 8 frames on either side, which makes it small in fast motion.
/// - jitter_mm: per joint the median of the eighth difference in windows of 0.4 s, the
///   20 % quantile of the windows, so that quiet parts count, and the 25 % quantile
///   of the joints, since noise is in all of them; as the standard deviation per axis of
///   white noise with that median. [mm]
/// - cut: the step between frames t and t + 1 that the steps around it do not continue:
///   the fifth difference over 6; the 75 % quantile of the joints, q; maximum of
///   q / (1 mm + 3 m), with m the median of q over 8 frames on either side. Steps before
///   and after must be regular, which those of a spike of the whole body are not.
///
/// 0 for motions of less than 12 frames. Linear in frames times joints.
[[nodiscard]] std::array<FoundFigure, 3> find_discontinuities(
    const QualityFrames& frames, const QualityLimits& limits);

}  // namespace marey::library
