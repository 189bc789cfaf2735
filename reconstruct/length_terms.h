// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: what is known of a body's lengths before it is measured.

#include <ceres/ceres.h>

#include "reconstruct/posture.h"

namespace marey::reconstruct {

/// People's lengths differ by a tenth; small parts are known no better than to a
/// centimetre. [m]
[[nodiscard]] double usual_length_sigma_m(double usual_m);

/// usual_length_sigma_m() of all, but where clavicles and the neck start is held: who has
/// data that tell it loosens them.
[[nodiscard]] Lengths usual_length_sigmas_m(const Lengths& usual);

/// Lengths are near those of an average person, give or take `sigma_m`, and both sides
/// alike.
void add_length_habits(const Lengths& usual,
                       const Lengths& sigma_m,
                       Lengths& lengths,
                       ceres::Problem& problem);

}  // namespace marey::reconstruct
