// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/engine/throw_trials.h"

namespace marey::recordings {

/// Parses the text of a list of trials (docs/formats/trials.md). `file` is its name in
/// messages. Each entry of "values" becomes a trial of its own, in the order of the file.
///
/// Errors (kBadInput), with the line: not TOML; another format; a key that is unknown,
/// missing, of the wrong type or out of range; a parameter and value that occur twice; no
/// throw, or more than 10000 with all repetitions.
[[nodiscard]] Result<TrialList> parse_trials(std::string_view text,
                                             const std::string& file);

/// Applies parse_trials() to the file at `path`. Additional error: it cannot be read.
[[nodiscard]] Result<TrialList> read_trials(const std::filesystem::path& path);

}  // namespace marey::recordings
