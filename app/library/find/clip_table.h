// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "recordings/library/library_records.h"

namespace marey::app {

/// Returns a row per line, cells in columns as wide as their widest cell (at most 48
/// characters; longer ones are not cut), two blanks apart, without blanks at the end.
/// Bytes that a terminal must not receive are replaced (printable()).
/// Precondition: all rows have the same number of cells.
[[nodiscard]] std::string table_text(const std::vector<std::vector<std::string>>& rows);

/// Returns the labels of a clip by people and tables as one text: "content:walk, slow".
[[nodiscard]] std::string label_list(const recordings::ClipSummary& clip);

/// Returns a clip of a list in JSON (docs/library_queries.md).
[[nodiscard]] nlohmann::ordered_json clip_json(const recordings::ClipSummary& clip);

/// Prints JSON on standard output. Bytes that are not UTF-8 are replaced.
void print_library_json(const nlohmann::ordered_json& json);

}  // namespace marey::app
