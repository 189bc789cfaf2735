// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/body.h"

namespace marey::app {

/// Returns warnings about a measured body that do not invalidate it: legs that differ by
/// more than three standard deviations from those of people of the declared stature;
/// shoulders and hips whose sigma is so large that every motion reports them as inferred.
[[nodiscard]] std::vector<std::string> body_warnings(const Body& body);

}  // namespace marey::app
