// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/jump/jump_options.h"
#include "app/jump/jump_run.h"

namespace marey::app {

/// Returns the output of `marey jump --json` (docs/formats/jump.md).
[[nodiscard]] nlohmann::ordered_json jump_json(const JumpArguments& args,
                                               const JumpRun& run);

}  // namespace marey::app
