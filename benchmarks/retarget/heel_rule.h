// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "benchmarks/retarget/contact_trials.h"

namespace marey {

/// Height of the heel's marker per frame; nullopt where it was not seen. Empty if the
/// foot has no such marker. [m]
[[nodiscard]] std::vector<std::optional<double>> marker_heights(const ContactTrial& trial,
                                                                int side);

/// Height of the same marker fixed to the fitted foot: at its median place relative to
/// the ankle. Empty if the foot has no such marker. [m]
[[nodiscard]] std::vector<std::optional<double>> fitted_heights(const ContactTrial& trial,
                                                                int side);

/// First instant, from 120 ms before a strike, at which a height comes within 10 mm of
/// its lowest of the next 0.2 s. The plates' strike limits the search, so errors are
/// those of the rule at best. nullopt if there is none within 150 ms after the strike.
[[nodiscard]] std::optional<double> strike_by_heel(
    const std::vector<std::optional<double>>& height_m, double hz, double strike_s);

}  // namespace marey
