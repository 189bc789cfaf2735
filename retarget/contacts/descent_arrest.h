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
/// share value and slope at the step are fitted to the 80 ms before and the 70 ms after
/// it, with weights that fade to the ends of these spans, so that no derivative of noisy
/// heights is taken. At low rates the spans are at least 3.5 frames. First the spans move
/// with the step; then the step alone is refined by at most 12 ms. Exact for a point with
/// constant accelerations before and after the step.
///
/// Candidates are within 50 ms of `near_frame`. Returns nullopt if the best one is at the
/// end of this range, has fewer than three frames on either side, is not upward, or is
/// smaller than four of its standard errors. `height_m` has one value per frame at `hz`.
/// Cost: 64 fits, each linear in the frames of its spans.
/// Precondition: the rate is positive.
[[nodiscard]] std::optional<DescentArrest> find_descent_arrest(
    std::span<const double> height_m, double hz, double near_frame);

}  // namespace marey::retarget
