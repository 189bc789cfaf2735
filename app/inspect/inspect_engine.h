// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/result.h"

namespace marey::app {

// Files of the engine: bases of clips, scenes and lists of trials. Errors: those of the
// readers.

/// Inspects a base of clips: the object of `marey base list --json`.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_base(
    const std::filesystem::path& file);
/// Inspects a scene: bodies, targets and actions in the order of the file.
[[nodiscard]] Result<nlohmann::ordered_json> inspect_scene(
    const std::filesystem::path& file);
[[nodiscard]] Result<nlohmann::ordered_json> inspect_trials(
    const std::filesystem::path& file);

/// Returns the same object with a line of text for each clip of a base, and for each
/// target and action of a scene.
[[nodiscard]] nlohmann::ordered_json engine_as_lines(nlohmann::ordered_json inspected);

}  // namespace marey::app
