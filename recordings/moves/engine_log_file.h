// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/engine/engine_log.h"

namespace marey::recordings {

/// Returns the bytes of a log of an engine (docs/formats/engine_log.md), from which
/// parse_engine_log() returns the same log, numbers to the bit. Same log, same bytes.
[[nodiscard]] std::string engine_log_bytes(const EngineLog& log);

/// Parses the bytes of a log. `file` is its name in messages. Linear. Errors (kBadInput):
/// another kind of file; a newer version of the format; cut short, or a sum that differs
/// from its content. EngineReplay checks the requests.
[[nodiscard]] Result<EngineLog> parse_engine_log(std::string_view bytes,
                                                 const std::string& file);

/// Writes engine_log_bytes() to `path`, as a whole or not at all. Errors: write_file()'s.
[[nodiscard]] Status write_engine_log(const std::filesystem::path& path,
                                      const EngineLog& log);

/// Applies parse_engine_log() to the file at `path`. Errors: also read_file()'s.
[[nodiscard]] Result<EngineLog> read_engine_log(const std::filesystem::path& path);

}  // namespace marey::recordings
