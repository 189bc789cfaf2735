// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::recordings {

/// Reads library.toml (docs/formats/library.md). Checks every key, and that shares of
/// splits add up to 1.
/// Errors (kBadInput), with file and line: not TOML; an unknown key, with the nearest
/// one; a value of another type or out of its range; the same source twice; a newer
/// format.
[[nodiscard]] Result<LibrarySettings> parse_library(std::string_view text,
                                                    const std::string& file);

/// Applies parse_library() to the file at `path`.
[[nodiscard]] Result<LibrarySettings> read_library(const std::filesystem::path& path);

/// Returns the text of a library.toml without sources.
[[nodiscard]] std::string new_library_text(std::string_view name);

/// Returns `text` with a [[source]] at its end. The rest is unchanged, comments included.
[[nodiscard]] std::string with_source(std::string text, const LibrarySource& source);

}  // namespace marey::recordings
