// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/detection.h"

namespace marey::recordings {

/// Returns the text of detections/CAMERA.csv, the detections in one camera's video. `key`
/// identifies the inputs (the video's content_key() and the detector's options); a reader
/// must use the same key. Numbers are exact. `broken_off` and `in_recording` are not
/// stored. Preconditions: `key` and the source are one line; the frames satisfy the
/// invariants of CameraDetections.
[[nodiscard]] std::string detections_text(const CameraDetections& detections,
                                          std::string_view key);

/// Writes detections_text() to `path`, as a whole or not at all. Errors: those of
/// write_file(); the source, which comes from the user's session, is not one line
/// (kBadInput).
[[nodiscard]] Status write_detections(const std::filesystem::path& path,
                                      const CameraDetections& detections,
                                      std::string_view key);

/// Parses the text of detections_text(). Returns nullopt if it has another key or another
/// format version, so is out of date. `file` is its name in error messages. Errors
/// (kBadInput), with the line: not such a table; an invalid row; frames, tags or points
/// out of order; a tag without area; no sigma; the end is missing. Cost: about a second
/// for a million rows.
[[nodiscard]] Result<std::optional<CameraDetections>> parse_detections(
    std::string_view text, std::string_view key, const std::string& file);

/// Applies parse_detections() to the file at `path`; returns nullopt if there is none.
[[nodiscard]] Result<std::optional<CameraDetections>> read_detections(
    const std::filesystem::path& path, std::string_view key);

}  // namespace marey::recordings
