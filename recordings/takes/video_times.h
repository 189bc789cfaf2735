// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/time.h"

namespace marey::recordings {

/// Returns the display time of each frame of a video from its container, ascending; edit
/// lists are applied. nullopt if the file cannot be read, if its frames have no times, or
/// if a time is more than 70 years away. Decodes nothing: the cost is reading the file.
[[nodiscard]] std::optional<std::vector<Timestamp>> video_times(
    const std::filesystem::path& path);

}  // namespace marey::recordings
