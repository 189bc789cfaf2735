// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: priors of a body's lengths.

#include <ceres/ceres.h>

#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

/// Returns length_sigma_m() of all lengths, but holds clavicles and the neck start.
/// Callers with data on these increase their sigmas.
[[nodiscard]] Lengths usual_length_sigmas_m(const Lengths& usual);

/// Adds priors to the problem: lengths near an average person's, with standard deviation
/// `sigma_m`, and equal on both sides.
void add_length_priors(const Lengths& usual,
                       const Lengths& sigma_m,
                       Lengths& lengths,
                       ceres::Problem& problem);

}  // namespace marey::reconstruct
