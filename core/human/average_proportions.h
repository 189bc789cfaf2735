// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/skeleton.h"

namespace marey {

/// Returns an average adult of the given stature, by the segment ratios of Drillis and
/// Contini (1966, as in Winter, "Biomechanics and Motor Control of Human Movement", fig.
/// 4.1).
/// Precondition: stature_m > 0.
[[nodiscard]] Proportions average_proportions(double stature_m);

}  // namespace marey
