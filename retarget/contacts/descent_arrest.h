// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace marey::retarget {

/// Sudden upward change of a vertical acceleration.
struct DescentArrest {
  double frame = 0.0;  ///< Between frames.
  double change_m_per_s2 = 0.0;
};

/// Finds where the descent of a point is arrested: the instant near `near_frame` at which
/// a step of its vertical acceleration explains most of its height. Two parabolas that
/// share value and slope at the step are fitted to the 70 ms before and the 60 ms after
/// it, with weights that fade to the ends of these spans, so that no derivative of noisy
/// heights is taken. At low rates the spans are at least 3.5 frames.
///
/// Candidates are within 40 ms of `near_frame`. Returns nullopt if the best one is at the
/// end of this range, less than three frames from an end of the heights, not upward, or
/// smaller than six of its standard errors.
/// Cost: 41 fits. `height_m` has one value per frame at `hz`.
/// Precondition: the rate is positive.
[[nodiscard]] std::optional<DescentArrest> find_descent_arrest(
    std::span<const double> height_m, double hz, double near_frame);

}  // namespace marey::retarget
