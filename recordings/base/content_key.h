// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace marey::recordings {

/// Returns a short word that changes when a recording changes: letters, digits and '-'.
/// For a file, it contains its size and a hash of all its bytes (XXH3, 128 bits). For a
/// folder, it contains their number and a hash of the names and keys of its files,
/// without subfolders. Not for secrets. Cost: reads every byte once, in pieces of 1 MiB;
/// the hash itself takes less than 0.1 s per GiB. Errors (kBadInput): no file at `path`,
/// or no permission to read it.
[[nodiscard]] Result<std::string> content_key(const std::filesystem::path& path);

}  // namespace marey::recordings
