// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "benchmarks/retarget/contact_trials.h"

namespace marey {

/// Offset between the clocks of force plates and markers.
struct PlateClock {
  double delay_s = 0.0;            ///< Plates after motion: positive. In steps of 1 ms.
  double unexplained_share = 0.0;  ///< Share of the force's variance.
};

/// Estimates the offset without contacts: the total vertical force is the mass times the
/// vertical acceleration of the centre of mass plus a constant. The offset is that at
/// which a line through the acceleration fits the force best, within 60 ms, while the
/// whole body stands on the plates. Both are smoothed by a Gaussian of 30 ms.
/// nullopt if the body is not on the plates for 0.25 s, or the best offset is at the end
/// of the search or explains less than 90 % of the variance.
[[nodiscard]] std::optional<PlateClock> plate_clock(const ContactTrial& trial);

}  // namespace marey
