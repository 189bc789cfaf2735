// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/marker_map.h"

namespace marey::recordings {

/// Parses a user's mapping of marker labels to names (docs/formats/markers.md, "Marker
/// map"): the table [markers] of a TOML file. "ignore" and "" become an empty name.
/// Does not check that names are known. `file` is the name of the text in error messages.
///
/// Errors (kBadInput), with the line: not TOML, which includes two equal labels; a key
/// outside [markers]; a value that is not text; no label.
[[nodiscard]] Result<MarkerMap> parse_marker_map(std::string_view text,
                                                 const std::string& file);

/// Applies parse_marker_map() to the file at `path`.
[[nodiscard]] Result<MarkerMap> read_marker_map(const std::filesystem::path& path);

}  // namespace marey::recordings
