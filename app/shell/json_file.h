// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"

namespace marey::app {

/// Reads a JSON file. Errors (kBadInput): it cannot be read, is not valid JSON, or is
/// nested deeper than recordings::kMaxNesting. Cost: linear.
[[nodiscard]] Result<nlohmann::ordered_json> read_json(const std::filesystem::path& path);

}  // namespace marey::app
