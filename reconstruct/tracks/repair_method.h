// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace marey::reconstruct {

/// Method by which a gap was filled.
enum class RepairMethod {
  kCluster,    ///< Carried along by the markers with the steadiest distances to it.
  kStructure,  ///< Also by the common movement of this trial's markers.
  kSpline,     ///< By its own path before and after: no other markers were usable.
  kLeftEmpty,  ///< Its sigma is too large.
};

/// Returns "cluster", "structure", "spline" or "left-empty", as in reports.
[[nodiscard]] std::string_view name(RepairMethod method);

}  // namespace marey::reconstruct
