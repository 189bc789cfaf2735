// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "recordings/marker_file.h"

namespace marey::recordings {

/// Reads the text of a TRC file, which knows no residuals, cameras or events. `file` is
/// what messages call it.
///
/// Liberties that programs take are taken too, and said in the notes: LF, CRLF or CR;
/// blank lines and columns; cells that are blank or NaN in any spelling, and rows that
/// end early, for markers that were not seen; commas for decimal points; numbers of
/// markers or frames in the header that are not those of the rows; a DataRate that is not
/// the Time column's, which is then believed; numbers of frames that are left out, which
/// become frames in which nothing was seen.
///
/// Errors (kBadInput), with the line: no header; a cell that is no number; more cells
/// than markers have; times that run backwards; no frame rate; more frames left out than
/// there are ten times over. Cost: linear in the text, about 50 MB/s.
[[nodiscard]] Result<MarkerFile> parse_trc(std::string_view text,
                                           const std::string& file,
                                           const MarkerReadOptions& options = {});

/// The TRC text of markers; `name` is what its first line says of the file. What was not
/// seen is left blank. Positions have the fewest digits, up to 15, from which reading
/// gives the same again, else 17. Tabs and line ends in labels become blanks.
/// Precondition: positions finite; rate above 0.
[[nodiscard]] std::string trc_text(const MarkerTracks& tracks,
                                   const FileAxes& axes,
                                   const std::string& name);

}  // namespace marey::recordings
