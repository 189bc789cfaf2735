// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace marey::recordings {

/// Returns a short word that changes when a recording changes: letters, digits and '-'.
/// For a file, it contains its size and a hash of its first and last MiB; a change of the
/// same size in the middle is not detected, which does not occur in videos. For a folder,
/// it contains the names and keys of its files, without subfolders. Not for secrets
/// (FNV-1a, 64 bits). Cost: reading up to 2 MiB of each file. Errors (kBadInput): no file
/// at `path`, or no permission to read it.
[[nodiscard]] Result<std::string> content_key(const std::filesystem::path& path);

}  // namespace marey::recordings
