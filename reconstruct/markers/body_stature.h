// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/humanoid.h"
#include "core/skeleton.h"
#include "reconstruct/labels/landmarks.h"

namespace marey::reconstruct {

/// A stature and its standard deviation. [m]
struct MeasuredStature {
  double stature_m = 0.0;
  double sigma_m = 0.0;
};

/// Computes the stature of a body from its measured lengths: from the sole along the
/// legs, the trunk and the head, with average values for the parts that were not
/// measured. `is_measured` states for every bone whether the distance to its parent was
/// measured.
/// Returns nullopt if neither legs nor trunk nor arms were measured. The standard
/// deviation is that of subjects of known stature: 2.2 % with legs and trunk, 3.5 % with
/// legs alone, 4.5 % with arms alone.
[[nodiscard]] std::optional<MeasuredStature> stature_of_body(
    const Proportions& proportions, const std::array<bool, kHumanBoneCount>& is_measured);

/// Returns the bones whose distance to their parent is measured by markers on these
/// landmarks: legs with markers on pelvis, knee and ankle, trunks with markers on pelvis
/// and chest, heads, arms with markers on shoulder, elbow and wrist.
[[nodiscard]] std::array<bool, kHumanBoneCount> bones_between(
    std::span<const Landmark* const> landmarks);

}  // namespace marey::reconstruct
