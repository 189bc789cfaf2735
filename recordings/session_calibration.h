// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "recordings/session.h"
#include "recordings/toml_reader.h"

// Private to recordings.
namespace marey::recordings {

/// What [calibration] of a session says. `folder` is what its paths are relative to.
/// Mistakes: an unknown word, with the nearest known one; what a wand cannot tell.
[[nodiscard]] CalibrationChoices read_calibration_choices(
    TomlReader& root, const std::filesystem::path& folder);

}  // namespace marey::recordings
