// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/detection.h"
#include "core/result.h"

namespace marey::recordings {

/// The text of detections/CAMERA.csv, which keeps what was found in one camera's video.
/// `key` says what it was made from and how (the video's content_key() and the detector's
/// options); reading asks for the same key. Numbers are exact. `broken_off` and
/// `in_recording` are not kept.
/// Precondition: `key` and the source are one line; the frames are as CameraDetections
/// promises.
[[nodiscard]] std::string detections_text(const CameraDetections& detections,
                                          std::string_view key);

/// Writes detections_text() to `path`, at once or not at all. Errors: as write_file()'s;
/// the source, which comes from the user's session, is not one line (kBadInput).
[[nodiscard]] Status write_detections(const std::filesystem::path& path,
                                      const CameraDetections& detections,
                                      std::string_view key);

/// Reads such a text. nullopt when it was made with another key or by another version of
/// the format: then it is simply out of date. `file` is what error messages call it.
/// Errors (kBadInput), with the line: not such a table; a row that does not fit; frames
/// tags or points out of order; a tag without area; no sigma; the end is missing. Cost:
/// about a second for a million rows.
[[nodiscard]] Result<std::optional<CameraDetections>> parse_detections(
    std::string_view text, std::string_view key, const std::string& file);

/// parse_detections() of the file at `path`; nullopt when there is none.
[[nodiscard]] Result<std::optional<CameraDetections>> read_detections(
    const std::filesystem::path& path, std::string_view key);

}  // namespace marey::recordings
