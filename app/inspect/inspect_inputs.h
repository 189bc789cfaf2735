// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"
#include "recordings/session/file_kind.h"

namespace marey::app {

// Functions that return the output of `marey inspect` for single files. Errors: those of
// the readers.

[[nodiscard]] Result<nlohmann::ordered_json> inspect_calibration(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_subject(
    const std::filesystem::path& file);

/// Inspects joints.csv, segments.csv or the positions written by `marey convert`. The
/// header of the table determines the kind.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_table(
    const std::filesystem::path& file);

/// Inspects a .mot or .sto file of OpenSim.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_angles(
    const std::filesystem::path& file);

/// Inspects an .asf file of Acclaim.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_acclaim(
    const std::filesystem::path& file);

/// Inspects a file of a kind that file_kind() detects. Errors also (kBadInput): a bone
/// map, which can only be inspected with its body; a session, see inspect_folder().
[[nodiscard]] Result<nlohmann::ordered_json> inspect_kind(
    const std::filesystem::path& file, recordings::FileKind kind);

}  // namespace marey::app
