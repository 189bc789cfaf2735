// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace marey::capture {

/// Whether the name says MP4 or QuickTime: the containers that count their frames.
[[nodiscard]] bool is_mp4(const std::filesystem::path& path);

/// How long an MP4 or QuickTime film says it plays, edit lists applied: the duration in
/// its movie header. [s] nullopt when there is none to be found. Reads a few dozen bytes.
/// Source: ISO/IEC 14496-12, 4.2 (boxes) and 8.2.2 (mvhd).
[[nodiscard]] std::optional<double> mp4_duration_s(const std::filesystem::path& path);

}  // namespace marey::capture
