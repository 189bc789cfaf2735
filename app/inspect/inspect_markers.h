// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"

namespace marey::app {

/// Returns the output of `marey inspect` for a C3D or TRC file. Errors: those of the
/// reader.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_markers(
    const std::filesystem::path& file);

}  // namespace marey::app
