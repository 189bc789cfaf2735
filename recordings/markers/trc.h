// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "recordings/markers/labelled_markers.h"

namespace marey::recordings {

/// Parses the text of a TRC file, which has no residuals, cameras or events. `file` is
/// its name in messages.
///
/// Accepts common deviations and reports them in the notes: LF, CRLF or CR; blank lines
/// and columns; cells that are blank or NaN in any spelling, and rows that end early, for
/// markers that were not seen; commas as decimal points; numbers of markers or frames in
/// the header that differ from the rows; a DataRate that differs from the Time column,
/// which then prevails; skipped frame numbers, which become frames without markers.
///
/// Errors (kBadInput), with the line: no header; a cell that is no number; more cells
/// than markers have; decreasing times; no frame rate; more than ten times as many
/// skipped frames as there are rows. Cost: linear in the text, about 50 MB/s.
[[nodiscard]] Result<MarkerFile> parse_trc(std::string_view text,
                                           const std::string& file,
                                           const MarkerReadOptions& options = {});

/// Returns the TRC text of markers; `name` is the file name in its first line. Markers
/// that were not seen are blank. Positions have the smallest number of digits, up to 15,
/// that reads back as the same value, else 17. Tabs and line ends in labels become
/// blanks. Preconditions: positions are finite; the rate is above 0.
[[nodiscard]] std::string trc_text(const MarkerTracks& tracks,
                                   const FileAxes& axes,
                                   const std::string& name);

}  // namespace marey::recordings
