// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"

namespace marey::recordings {

/// When each frame was taken, by a table that the recording computer wrote (Caliscope's
/// timestamps.csv): comma separated, its first line naming the columns, of which
/// `cam_id` (or `camera`, `port`) and `frame_time` [s] are read; a row for each frame,
/// the rows of a camera in the order of its video. A camera is called as its video, or by
/// the number at the end of that name. Rows of other cameras are passed over.
///
/// `videos` are names without folder and ending. The answer is in their order, times from
/// that of the earliest frame on. Errors (kBadInput), with the line: a column is missing;
/// a row has another number of fields; a time is not a number, or before the one above
/// it; no row is of a camera. Otherwise as read_file()'s. Precondition: at least one
/// video.
[[nodiscard]] Result<std::vector<std::vector<Timestamp>>> read_frame_stamps(
    const std::filesystem::path& path, std::span<const std::string> videos);

}  // namespace marey::recordings
