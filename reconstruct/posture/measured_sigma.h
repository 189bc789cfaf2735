// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::reconstruct {

/// Limb joints with larger sigmas are reported as inferred: at this sigma one in 900
/// errors exceeds 60 mm, at 20 mm one in 34.
inline constexpr double kMaxMeasuredSigma_m = 0.015;

}  // namespace marey::reconstruct
