// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::recordings {

/// Returns the SHA-256 of `bytes` (FIPS 180-4) as 64 lower-case hexadecimal digits, by
/// FFmpeg's libavutil. Linear.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Returns the SHA-256 of the file at `path`, read in pieces of 1 MiB.
/// Errors (kBadInput): those of check_input_file(); it cannot be read.
[[nodiscard]] Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace marey::recordings
