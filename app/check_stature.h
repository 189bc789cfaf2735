// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/body.h"

namespace marey::app {

/// Returns a warning if the legs of a measured body differ by more than three standard
/// deviations from those of people of the declared stature; nullopt otherwise.
[[nodiscard]] std::optional<std::string> stature_warning(const Body& body);

}  // namespace marey::app
