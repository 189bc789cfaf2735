// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

namespace marey::library {

/// Measures deviations of joints from smooth paths: "spike", "jitter_mm" and "cut". They
/// are differences of a high order, which smooth motion hardly contains.
///
/// - spike: e(t) is the eighth difference of a joint's positions over 70, so that a
///   single displaced position counts in full; maximum of |e| / (s + c m), with m the
///   median of |e| over the frames on either side that a spike at t does not change. s is
///   16 mm and c 0.5 at 30 Hz; at higher rates s goes down in inverse proportion, to
///   4 mm, and c up, to 1.5.
/// - jitter_mm: eighth differences of each bone's end in the frame of the bone's parent:
///   noise is in each joint, whereas neighbouring bones share smooth motion and impacts.
///   Per bone the median in windows of 0.4 s, the 20 % quantile of the windows, so that
///   quiet parts count, and the 25 % quantile of the bones; as the standard deviation per
///   axis of white noise with that median. Independent noise of 1 mm in all joints gives
///   1.1. A third of the same figure of the joints' places in the world replaces it if
///   larger: noise of the root alone. [mm]
/// - cut: the step of a joint between frames t and t + 1 that the steps around it do not
///   continue: q(t) is the fifth difference over 6; q / (0.6 mm + 3 m), with m the 93 %
///   quantile of q over the frames on either side that a cut at t does not change. The
///   third largest of the body's joints counts, and the maximum of the frames. Steps
///   before and after must be regular, which those of a displaced joint are not.
///
/// 0 for motions of less than 12 frames. Linear in frames times joints.
[[nodiscard]] std::array<FoundFigure, 3> find_discontinuities(
    const QualityFrames& frames, const QualityLimits& limits);

}  // namespace marey::library
