// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"

namespace marey::recordings {

/// A short word that changes when a recording does: letters, digits and '-'. Of a file,
/// its size and a hash of its first and last MiB; a change of the same size in the middle
/// goes unseen, which videos do not do. Of a folder, the names and keys of the files in
/// it, not of folders below. Not for secrets (FNV-1a, 64 bits). Cost: reading up to 2 MiB
/// of each file.
/// Errors (kBadInput): there is nothing at `path`, or it may not be read.
[[nodiscard]] Result<std::string> content_key(const std::filesystem::path& path);

}  // namespace marey::recordings
