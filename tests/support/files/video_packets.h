// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace marey::testing {

/// Another program that knows videos.
inline constexpr const char* kFfmpeg = "/usr/bin/ffmpeg";

/// The packets of a video, one after the other, as ffmpeg reads them; a test fails where
/// it does not. Writes VIDEO.bin. Precondition: kFfmpeg is there.
[[nodiscard]] std::string video_packets(const std::filesystem::path& video);

}  // namespace marey::testing
