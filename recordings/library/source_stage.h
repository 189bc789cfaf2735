// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

/// Result of reading a source: its bodies, or the reason why it gave none.
struct SourceStage {
  /// A record per body: its name, the key, the frames and the rate of its motion, and the
  /// figures, labels and events that only the source has. The rest is empty.
  std::vector<ClipRecord> bodies;
  /// Bytes of the motion of each body: another size is a damaged object.
  std::vector<std::uint64_t> motion_bytes;
  std::vector<std::string> remarks;
  std::optional<Error> failure;  ///< If set, there are no bodies.
};

/// Returns the text of a stage, a JSON object. Same input, same bytes.
/// Precondition: numbers are finite.
[[nodiscard]] std::string source_stage_text(const SourceStage& stage);

/// Reads a text of source_stage_text(). nullopt: it is damaged, and the source is to be
/// read again.
[[nodiscard]] std::optional<SourceStage> parse_source_stage(std::string_view text);

/// Returns the texts of several records in one JSON array.
[[nodiscard]] std::string clip_records_text(const std::vector<ClipRecord>& records);

/// Reads a text of clip_records_text(). nullopt: it is damaged.
[[nodiscard]] std::optional<std::vector<ClipRecord>> parse_clip_records(
    std::string_view text);

}  // namespace marey::recordings
