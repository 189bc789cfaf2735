// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// Result of a source: the objects that were made of it, or the reason why there are
/// none.
struct SourceOutcome {
  std::string name;       ///< SourceFile::name.
  std::string source_id;  ///< Empty: it could not be read.
  std::string clips_key;  ///< Key of its clips' records and features; empty: none.
  std::optional<Error> failure;
  std::vector<std::string> remarks;
  bool was_read = false;  ///< The source was read: its motion was no object yet.
  /// The machine failed, not the source: its disk, its memory, its processes. The source
  /// may succeed in the next build.
  bool is_machine_failure = false;
};

/// Returns an outcome as one line of JSON, without its end.
[[nodiscard]] std::string outcome_text(const SourceOutcome& outcome);

/// Reads a text of outcome_text(). nullopt: it is damaged.
[[nodiscard]] std::optional<SourceOutcome> parse_outcome(std::string_view text);

}  // namespace marey::app
