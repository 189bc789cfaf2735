// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace marey::retarget {

/// The least smooth curve of its kind above `needed`: the greatest within +-half a window
/// of `half` frames, averaged over as much with a C2 bell. Every value averaged is at
/// least the one needed in the middle, so the average is too. Zero further than 2 half
/// from all that is not. Linear in frames times `half`.
/// Precondition: half >= 0; needed >= 0.
[[nodiscard]] std::vector<double> smooth_cover(std::span<const double> needed, int half);

}  // namespace marey::retarget
