// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/floor.h"

namespace marey::recordings {

/// Returns the text of a floor's file (docs/formats/floor.md). parse_floor() returns the
/// same doubles, except for rounding of the heights and slopes of ramps, which the file
/// stores by their edges. Preconditions: every number is finite; a ramp rises along X or
/// Z, not both.
[[nodiscard]] std::string floor_text(const Floor& floor);

/// Parses a floor's file. `file` is the name of the text in error messages. Errors
/// (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type or out
/// of range; a part without a name or with another's, without a size, or with none or
/// several of `top_m`, `ramp_x_m` and `ramp_z_m`; a ramp steeper than 60 degrees; times
/// that do not ascend, or whose number differs from that of the positions.
[[nodiscard]] Result<Floor> parse_floor(std::string_view text, const std::string& file);

/// Applies parse_floor() to the file at `path`.
[[nodiscard]] Result<Floor> read_floor(const std::filesystem::path& path);

}  // namespace marey::recordings
