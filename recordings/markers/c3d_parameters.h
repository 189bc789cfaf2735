// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/markers/c3d.h"

namespace marey::recordings {

/// Parses the groups and parameters of a parameter section. `bytes` is the beginning of
/// the file; the first record is at `begin`, and no record may extend beyond `end`.
/// Records that do, or that are invalid, are skipped and reported in `notes`. Never
/// fails. Precondition: begin <= end <= bytes.size().
[[nodiscard]] std::vector<C3dGroup> parse_c3d_parameters(std::string_view bytes,
                                                         std::size_t begin,
                                                         std::size_t end,
                                                         C3dProcessor processor,
                                                         std::vector<std::string>& notes);

/// Returns the parameter section in whole blocks of 512 bytes, its own four bytes
/// included. Errors: names, descriptions or values that exceed the format's limits.
[[nodiscard]] Result<std::string> c3d_parameter_section(
    const std::vector<C3dGroup>& groups, C3dProcessor processor);

}  // namespace marey::recordings
