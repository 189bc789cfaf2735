// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/library/clip_record.h"

namespace marey::app {

/// Appends a field of a CSV (RFC 4180), in quotation marks if it needs them.
void append_csv(std::string& line, std::string_view field);

/// Returns the columns of clip_line(), without the end of the line.
[[nodiscard]] std::string clip_columns();
/// Returns the facts of a clip as a line of CSV, without its end.
[[nodiscard]] std::string clip_line(const ClipRecord& record);

// Tables of clips, each with a line of columns; docs/formats/library_exports.md.
[[nodiscard]] std::string clips_csv(std::span<const ClipRecord> records);
[[nodiscard]] std::string figures_csv(std::span<const ClipRecord> records);
[[nodiscard]] std::string labels_csv(std::span<const ClipRecord> records);
[[nodiscard]] std::string splits_csv(std::span<const ClipRecord> records);

}  // namespace marey::app
