// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace marey::retarget {

/// Returns a smooth curve that is nowhere below `needed`: the maximum over a window of
/// `half` frames to either side, averaged over the same window with the triweight kernel.
/// Each averaged value is at least the one needed in the middle, so the average is too.
/// Zero where `needed` is zero within 2 half frames. Linear in frames times `half`.
/// Precondition: half >= 0; needed >= 0.
[[nodiscard]] std::vector<double> smooth_cover(std::span<const double> needed, int half);

}  // namespace marey::retarget
