// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace marey::capture {

/// Returns true if the file name is that of MP4 or QuickTime: the containers that count
/// their frames.
[[nodiscard]] bool is_mp4(const std::filesystem::path& path);

/// Returns the duration in the movie header of an MP4 or QuickTime file, with edit lists
/// applied. [s] nullopt if there is none. Reads a few dozen bytes.
/// Source: ISO/IEC 14496-12, 4.2 (boxes) and 8.2.2 (mvhd).
[[nodiscard]] std::optional<double> mp4_duration_s(const std::filesystem::path& path);

}  // namespace marey::capture
