// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "recordings/base/toml_reader.h"
#include "recordings/session/session.h"

// Private to recordings.
namespace marey::recordings {

/// Reads [calibration] of a session. Its paths are relative to `folder`. Mistakes: an
/// unknown word (reported with the nearest known one); options that a wand cannot
/// determine.
[[nodiscard]] CalibrationChoices read_calibration_choices(
    TomlReader& root, const std::filesystem::path& folder);

}  // namespace marey::recordings
