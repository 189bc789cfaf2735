// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/marker_map.h"
#include "core/result.h"

namespace marey::recordings {

/// Reads what somebody says that marker labels mean (docs/formats.md, "Marker names"):
/// the table [markers] of a TOML file. "ignore" and "" become an empty name; whether
/// names are known is not asked here. `file` is what error messages call the text.
///
/// Errors (kBadInput), with the line: not TOML, which two equal labels are not either;
/// a key beside [markers]; a value that is not text; no label.
[[nodiscard]] Result<MarkerMap> parse_marker_map(std::string_view text,
                                                 const std::string& file);

/// parse_marker_map() of the file at `path`.
[[nodiscard]] Result<MarkerMap> read_marker_map(const std::filesystem::path& path);

}  // namespace marey::recordings
