// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/table_cells.h"
#include "recordings/markers/marker_file.h"

namespace marey::recordings {

/// Content of a TRC before its rows.
struct TrcHeader {
  std::optional<double> rate_hz;
  std::optional<int> frames;
  std::optional<int> markers;
  std::string unit;
  std::vector<std::string> labels;  ///< As in the file; may be empty or repeated.
  CellMark mark = CellMark::kTab;   ///< Separator of cells.
  bool has_axes_row = false;        ///< The row X1 Y1 Z1 was read.
};

/// Reads up to the line of the labels. Errors (kBadInput), with the line: not a TRC file,
/// or it ends in its header.
[[nodiscard]] Result<TrcHeader> read_trc_header(LineReader& lines,
                                                const std::string& file);

[[nodiscard]] FileAxes trc_axes(const TrcHeader& header,
                                const AxisFinder& finder,
                                const MarkerReadOptions& options,
                                std::vector<std::string>& notes);

/// Frame number of each row, and the rate.
struct TrcFrames {
  double rate_hz = 100.0;
  int first_frame = 1;
  std::size_t count = 0;
  std::vector<std::size_t> frame_of_row;
};

/// Determines the rate and the skipped frames from the rows' numbers and times. Errors:
/// those of parse_trc().
[[nodiscard]] Result<TrcFrames> place_trc_rows(const TrcHeader& header,
                                               const std::vector<double>& numbers,
                                               const std::vector<double>& times_s,
                                               const std::string& file,
                                               int last_line,
                                               std::vector<std::string>& notes);

}  // namespace marey::recordings
