// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

#include "retarget/body/body_map.h"

namespace marey::library {

/// Measures whether lengths and postures are those of a human: "scale_sigma",
/// "limits_deg" and "self_mm"; without a verdict "stature_m" and "proportions".
///
/// - stature_m: that of an average adult with the same length of leg. [m]
/// - proportions: a weighted sum of the logarithms of the lengths of thigh, shank, upper
///   arm, forearm, spine and the distance of the hip joints. The weights add up to 0: it
///   is the same for a body of another size with the same proportions. 0: unknown.
/// - scale_sigma: maximum deviation in standard deviations of the stature that follows
///   from the legs (1.63 m, 10 %: 1.2 m and 2.2 m are 3), of shank to thigh, arm to leg
///   and forearm to upper arm from average_proportions() (15 % each).
/// - limits_deg: per bone the 99 % quantile of the excess of its rotation over
///   joint_range(), in the parent bone and relative to the T-pose; the maximum of the
///   bones. [deg]
/// - self_mm: maximum depth of a wrist in the average volume of trunk and head for this
///   skeleton. [mm]
///
/// Linear in frames times bones.
/// Precondition: `map` is of the body that moves.
[[nodiscard]] std::array<FoundFigure, 5> check_body(const QualityFrames& frames,
                                                    const retarget::BodyMap& map,
                                                    const QualityLimits& limits);

}  // namespace marey::library
