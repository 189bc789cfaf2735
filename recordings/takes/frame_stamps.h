// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace marey::recordings {

/// Reads the time of each frame from a table written by the recording computer
/// (Caliscope's timestamps.csv): comma separated, with column names in its first line, of
/// which `cam_id` (or `camera`, `port`) and `frame_time` [s] are read. There is a row for
/// each frame; the rows of a camera are in the order of its video. A camera is identified
/// by the name of its video, or by the number at the end of that name. Rows of other
/// cameras are ignored.
///
/// `videos` are names without folder and extension. The result is in their order; times
/// are relative to the earliest frame. Errors (kBadInput), with the line: a column is
/// missing; a row has another number of fields; a time is not a number, or is before the
/// one above it; no row belongs to a camera. Otherwise the errors of read_file().
/// Precondition: at least one video.
[[nodiscard]] Result<std::vector<std::vector<Timestamp>>> read_frame_stamps(
    const std::filesystem::path& path, std::span<const std::string> videos);

}  // namespace marey::recordings
