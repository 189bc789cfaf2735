// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/body.h"
#include "core/finding.h"

namespace marey::app {

/// Returns fair findings about a measured body, without a place: legs that differ by
/// more than three standard deviations from those of people of the declared stature;
/// shoulders and hips whose sigma is so large that every motion reports them as inferred.
[[nodiscard]] std::vector<Finding> assess_body(const Body& body);

}  // namespace marey::app
