// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/clips/motion_base.h"
#include <nlohmann/json_fwd.hpp>

namespace marey::app {

/// Returns the clips of a base as a table with a line of titles: name, seconds, rate,
/// number of phases, speed, loops, tags, bytes.
[[nodiscard]] std::string base_table(const engine::MotionBase& base);

/// Returns the clips of a base in JSON (docs/formats/moves.md).
[[nodiscard]] nlohmann::ordered_json base_json(const engine::MotionBase& base);

}  // namespace marey::app
