// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"

namespace marey::app {

// Functions that return the output of `marey inspect` for results and takes. Errors:
// those of the readers.

/// Inspects a .json file written by marey: report, fit, plan, calibration or repair.
/// Errors also (kBadInput): another file.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_report(
    const std::filesystem::path& file);

/// Inspects a folder with a session, results, one trial of results, a recorded take or a
/// live take. Errors also (kBadInput): the folder has none of these.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_folder(
    const std::filesystem::path& folder);

[[nodiscard]] Result<nlohmann::ordered_json> inspect_session(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_take(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_live_take(
    const std::filesystem::path& file);

}  // namespace marey::app
