// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"

namespace marey::library {

/// Returns for each frame whether all limb bones are within 15 degrees of their direction
/// in the T-pose, relative to the hips: 1 or 0. Linear in frames.
[[nodiscard]] std::vector<char> t_pose_frames(const QualityFrames& frames,
                                              const retarget::BodyMap& map);

/// Measures the activity of a motion; no verdict follows from it: "seconds",
/// "sparc", "speed_m_s", "still_share" and "tpose_share".
///
/// - sparc: spectral arc length of the speed of hips and hands, smooth motion is near 0:
///   minus the integral over [0, f_c] of sqrt((1 / f_c)^2 + (dV/df)^2), V the amplitude
///   spectrum over its first value, f_c the highest frequency up to 10 Hz at which V is
///   0.05 or more. Mean over windows of 4 s and the three joints. (Balasubramanian,
///   Melendez-Calderon, Roby-Brami, Burdet 2015, "On the analysis of movement
///   smoothness".)
/// - seconds: from the first frame to the last one. [s]
/// - speed_m_s: mean level speed of the hips. [m/s]
/// - still_share: share of frames in which every joint is slower than 5 cm/s.
/// - tpose_share: share of frames of t_pose_frames().
///
/// Linear in frames.
[[nodiscard]] std::array<FoundFigure, 5> measure_activity(const QualityFrames& frames,
                                                          const retarget::BodyMap& map);

}  // namespace marey::library
