// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "live/page/page_scene.h"

namespace marey::app {

/// Reads the cameras of a calibration.toml. Errors: those of the reader.
[[nodiscard]] Result<std::vector<live::PageCamera>> page_cameras(
    const std::filesystem::path& file);

}  // namespace marey::app
