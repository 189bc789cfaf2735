// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/time.h"

namespace marey::recordings {

/// When each frame of a video is to be shown, ascending, by its container; edit lists are
/// applied. nullopt when the file cannot be read, or its frames carry no times, or some
/// that are more than 70 years away. Nothing is decoded: the cost is reading the file.
[[nodiscard]] std::optional<std::vector<Timestamp>> video_times(
    const std::filesystem::path& path);

}  // namespace marey::recordings
