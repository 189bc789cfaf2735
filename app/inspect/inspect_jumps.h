// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "dynamics/jumps/jump.h"
#include <nlohmann/json.hpp>

namespace marey::app {

/// Returns the list of jumps of a motion for `marey inspect` (docs/formats/inspect.md).
[[nodiscard]] nlohmann::ordered_json jumps_json(std::span<const dynamics::Jump> jumps);

/// Returns the content of a motion with its jumps in readable form, one line per jump and
/// per finding.
[[nodiscard]] nlohmann::ordered_json jumps_as_lines(nlohmann::ordered_json inspected);

}  // namespace marey::app
