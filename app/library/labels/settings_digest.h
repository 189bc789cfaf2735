// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// Returns the SHA-256 of all inputs of a library except its sources: library.toml, the
/// index tables, the tables of labels. An index states the digest that it was made from
/// (recordings::IndexHead::settings). Errors (kBadInput): one of them cannot be read.
[[nodiscard]] Result<std::string> settings_digest(const std::filesystem::path& library,
                                                  const LibrarySettings& settings);

}  // namespace marey::app
