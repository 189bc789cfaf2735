// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/c3d.h"

namespace marey::recordings {

/// The groups and parameters of a file's parameter section. `bytes` are the file's first
/// ones; the first record is at `begin`, and none may reach beyond `end`. Records that
/// do, or that make no sense, are left out and told in `notes`; never fails.
/// Precondition: begin <= end <= bytes.size().
[[nodiscard]] std::vector<C3dGroup> parse_c3d_parameters(std::string_view bytes,
                                                         std::size_t begin,
                                                         std::size_t end,
                                                         C3dProcessor processor,
                                                         std::vector<std::string>& notes);

/// The parameter section, whole blocks of 512 bytes, its own four bytes included. Errors:
/// names, descriptions or values that are longer than the format has room for.
[[nodiscard]] Result<std::string> c3d_parameter_section(
    const std::vector<C3dGroup>& groups, C3dProcessor processor);

}  // namespace marey::recordings
