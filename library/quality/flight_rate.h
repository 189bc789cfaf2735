// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "library/quality/found_figure.h"
#include "library/quality/quality_frames.h"
#include "library/quality/quality_limits.h"

namespace marey::library {

/// Free fall of the centre of mass between two contacts with the floor.
struct FreeFall {
  FrameRange frames;  ///< Frames of the fit.
  double gravity_m_s2 = 0.0;
};

/// Finds flights: both soles are 2 cm or more above the level of standing feet (the 5 %
/// quantile of the lower sole) in at least five frames, and the height of the centre of
/// mass in the middle 80 % of these is a parabola: its height over the chord is at least
/// 2.5 cm, and the RMS of the residuals below 8 % of that. The fitted gravity
/// is s / k^2 times the real one for a body scaled by s and a rate that is stated as k
/// times the real one. Linear in frames.
[[nodiscard]] std::vector<FreeFall> find_free_falls(const QualityFrames& frames);

/// Measures "rate_ratio" and "flights".
/// - rate_ratio: median gravity of the flights over 9.81 m/s^2, or its inverse if that is
///   larger. 0 with fewer than two flights: then nothing is known about the rate.
/// - flights: their number.
[[nodiscard]] std::array<FoundFigure, 2> measure_flight_rate(const QualityFrames& frames,
                                                             const QualityLimits& limits);

}  // namespace marey::library
