// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"
#include "recordings/session/file_kind.h"

namespace marey::app {

// What `marey inspect` prints of single files. Errors: those of the readers.

[[nodiscard]] Result<nlohmann::ordered_json> inspect_calibration(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_subject(
    const std::filesystem::path& file);

/// joints.csv, segments.csv or the places that marey convert writes, by the header.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_table(
    const std::filesystem::path& file);

/// OpenSim's .mot or .sto.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_angles(
    const std::filesystem::path& file);

/// Acclaim's .asf.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_acclaim(
    const std::filesystem::path& file);

/// A file whose kind file_kind() tells. Errors also (kBadInput): a bone map, which says
/// nothing without its body; a session, whose folder is inspected elsewhere.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_kind(
    const std::filesystem::path& file, recordings::FileKind kind);

}  // namespace marey::app
