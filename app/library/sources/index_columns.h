// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace marey::app {

/// Meaning of a column of an index table.
enum class IndexColumn {
  kFile,
  kSubject,
  kTrial,
  kRate,
  kDescription,
  kLabels,
  kDuration
};

/// Returns the meaning of a column by its header: docs/formats/library.md, "Index
/// tables". nullopt: it is not read.
[[nodiscard]] std::optional<IndexColumn> column_of(std::string_view header);

/// Returns the rate of a column that counts frames, such as "Frames 60fps"; 0: it does
/// not.
[[nodiscard]] double counted_rate_hz(std::string_view header);

}  // namespace marey::app
