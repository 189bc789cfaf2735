// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/floor.h"
#include "core/result.h"

namespace marey::recordings {

/// The text of a floor's file (docs/formats.md). parse_floor() gives the same doubles,
/// but for heights and slopes of ramps: to rounding, as the file tells of their edges.
/// Precondition: every number finite; a ramp rises along X or Z, not both.
[[nodiscard]] std::string floor_text(const Floor& floor);

/// Reads a floor's file. `file` is what error messages call the text.
/// Errors (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type
/// or out of range; a part without a name or with another's, without a size, or with none
/// or several of `top_m`, `ramp_x_m` and `ramp_z_m`; a ramp steeper than 60 degrees;
/// times that do not ascend or are not as many as places.
[[nodiscard]] Result<Floor> parse_floor(std::string_view text, const std::string& file);

/// parse_floor() of the file at `path`.
[[nodiscard]] Result<Floor> read_floor(const std::filesystem::path& path);

}  // namespace marey::recordings
