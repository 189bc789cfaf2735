// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: expected place of a landmark's marker on a body that is not
// measured yet.

#include <optional>

#include "reconstruct/labels/landmarks.h"
#include "reconstruct/markers/hip_regression.h"
#include "reconstruct/markers/marker_bundle.h"

namespace marey::reconstruct {

/// Returns the prior of a landmark's place on its solved segment: the landmark's table
/// for a body of this stature; for the pelvis' spines the regression if there is one.
[[nodiscard]] MarkerPlacePrior landmark_prior(const Landmark& landmark,
                                              double stature_m,
                                              const Proportions& average,
                                              const std::optional<HipRegression>& hips,
                                              const BodyConstants& frame);

}  // namespace marey::reconstruct
