// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "recordings/marker_file.h"
#include "recordings/trc_cells.h"

namespace marey::recordings {

/// What a TRC says before its rows.
struct TrcHeader {
  std::optional<double> rate_hz;
  std::optional<int> frames;
  std::optional<int> markers;
  std::string unit;
  std::vector<std::string> labels;  ///< As they are, perhaps empty or twice.
  CellMark mark = CellMark::kTab;   ///< What parts the cells.
  bool has_axes_row = false;        ///< X1 Y1 Z1 was read.
};

/// Reads up to the line of the labels. Errors (kBadInput), with the line: this is no TRC,
/// or it ends in its header.
[[nodiscard]] Result<TrcHeader> read_trc_header(LineReader& lines,
                                                const std::string& file);

[[nodiscard]] FileAxes trc_axes(const TrcHeader& header,
                                const AxisFinder& finder,
                                const MarkerReadOptions& options,
                                std::vector<std::string>& notes);

/// Where the rows are in time.
struct TrcFrames {
  double rate_hz = 100.0;
  int first_frame = 1;
  std::size_t count = 0;
  std::vector<std::size_t> frame_of_row;
};

/// Finds the rate and the frames that were left out, from the rows' numbers and times.
/// Errors: as parse_trc()'s.
[[nodiscard]] Result<TrcFrames> place_trc_rows(const TrcHeader& header,
                                               const std::vector<double>& numbers,
                                               const std::vector<double>& times_s,
                                               const std::string& file,
                                               int last_line,
                                               std::vector<std::string>& notes);

}  // namespace marey::recordings
