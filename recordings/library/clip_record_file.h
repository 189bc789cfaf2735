// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

/// Returns the text of a clip's record (docs/formats/library.md), one JSON object with
/// all keys in a fixed order. Same input, same bytes. Precondition: numbers are finite.
[[nodiscard]] std::string clip_record_text(const ClipRecord& record);

/// Reads a text of clip_record_text(). Errors (kBadInput), with the key: not JSON; a key
/// that is missing or unknown; a value of another type; a newer format.
[[nodiscard]] Result<ClipRecord> parse_clip_record(std::string_view text,
                                                   const std::string& file);

/// Returns the id of a clip: the first 16 hexadecimal digits of the SHA-256 of its
/// source, its body and its frames in the source.
[[nodiscard]] std::string clip_id_of(const std::string& source_id,
                                     const std::string& body,
                                     int first_frame,
                                     int last_frame);

/// Returns the key of the result of a stage: SHA-256 of the source, the stage's name and
/// version, the text of all options that it reads, and the key of the stage before.
[[nodiscard]] std::string stage_key(const std::string& source_id,
                                    std::string_view stage,
                                    int version,
                                    std::string_view options,
                                    std::string_view before);

/// Returns the place of an object in a library: "objects/ab/cdef...". `extension` is
/// ".npz" or ".json". Precondition: `key` has 64 digits.
[[nodiscard]] std::filesystem::path object_path(const std::string& key,
                                                std::string_view extension);

}  // namespace marey::recordings
