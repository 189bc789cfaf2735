// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: where a landmark's marker is on a body that is not measured
// yet.

#include <optional>

#include "reconstruct/hip_regression.h"
#include "reconstruct/landmarks.h"
#include "reconstruct/marker_bundle.h"

namespace marey::reconstruct {

/// Returns the prior of a landmark's place on its solved segment: the landmark's table on
/// a body of this stature; of the pelvis' spines the regression where there is one.
[[nodiscard]] PlaceBelief landmark_belief(const Landmark& landmark,
                                          double stature_m,
                                          const Proportions& average,
                                          const std::optional<HipRegression>& hips,
                                          const BodyFrame& frame);

}  // namespace marey::reconstruct
