// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"

namespace marey::app {

// What `marey inspect` prints of results and takes. Errors: those of the readers.

/// A .json that marey wrote: report, fit, plan, calibration or repair. Errors also: not
/// one of these.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_report(
    const std::filesystem::path& file);

/// A folder: a session, results, one trial of results, a recorded take or a live take.
/// Errors also (kBadInput): it holds nothing of these.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_folder(
    const std::filesystem::path& folder);

[[nodiscard]] Result<nlohmann::ordered_json> inspect_session(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_take(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_live_take(
    const std::filesystem::path& file);

}  // namespace marey::app
