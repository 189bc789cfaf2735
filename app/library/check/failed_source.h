// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// A source of a library that gave no clip. Texts are printable.
struct FailedSource {
  std::string source;  ///< Name of the source, as in library.sqlite.
  std::string where;   ///< File, and line or byte.
  std::string cause;
  std::string next;  ///< Empty: unknown.
};

/// Reads failed/ of a library (docs/formats/library.md), in ascending order of sources. A
/// file of another form is a cause as a whole. No such folder: no failures. Errors
/// (kBadInput): a file that cannot be read.
[[nodiscard]] Result<std::vector<FailedSource>> read_failed_sources(
    const std::filesystem::path& library);

}  // namespace marey::app
