// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace marey {

/// Checks that a path names a readable file, before any reader opens it: reading would
/// block on a pipe and never end on a device. Follows links.
///
/// Errors (kBadInput), at `name`, or at the path if that is empty: it does not exist, is
/// a folder, a pipe, a device or a socket, or its folder may not be searched.
[[nodiscard]] Status check_input_file(const std::filesystem::path& path,
                                      const std::string& name = {});

}  // namespace marey
