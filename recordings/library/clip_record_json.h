// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "core/base/result.h"
#include "core/library/clip_record.h"

// Private to recordings/: records of clips as parts of JSON files.
namespace marey::recordings {

/// Returns a record as a JSON object with all keys in a fixed order.
[[nodiscard]] nlohmann::ordered_json clip_record_json(const ClipRecord& record);

/// Reads an object of clip_record_json(). Stores the first mistake, as
/// parse_clip_record() returns it; values after it are empty.
[[nodiscard]] ClipRecord read_clip_record(const nlohmann::ordered_json& root,
                                          const std::string& file,
                                          std::optional<Error>& mistake);

}  // namespace marey::recordings
