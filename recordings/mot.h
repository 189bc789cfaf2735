// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace marey::recordings {

struct MotColumn {
  std::string name;
  /// The values are radians here (or radians per second) and degrees in the file. Of all
  /// other columns they are the file's own numbers: metres, newtons, what it may be.
  bool is_angle = false;
};

/// OpenSim's motion and storage files (.mot, .sto): named columns against time.
struct MotTable {
  std::string name;                ///< The file's first line.
  std::vector<MotColumn> columns;  ///< Without the time.
  std::vector<double> time_s;      ///< Never runs backwards.
  /// Row by row; NaN where the file says so.
  std::vector<double> values;
  std::vector<std::string> notes;  ///< What was odd in the file that was read.

  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * columns.size() + column];
  }
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return values[row * columns.size() + column];
  }
  /// The first column of this coordinate: its name, or that of its value in a file of
  /// states, "/jointset/hip_r/hip_flexion_r/value". Linear in columns.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view coordinate) const;
};

/// Whether OpenSim's models of the whole body (Rajagopal2016, gait2392, gait2354, Hamner,
/// LaiArnold) have a rotation of this name, or a state of one. `knee_angle_r_beta` is
/// none: OpenSim writes it in radians always.
[[nodiscard]] bool is_rotation(std::string_view column);

/// Reads the text of a .mot or .sto file. `file` is what messages call it.
///
/// Which columns are angles is known to OpenSim's models alone, so it goes by their names
/// (is_rotation()): they become radians if the file is in degrees. It is when its header
/// says inDegrees=yes, and when it has neither that nor a version, as SIMM's files do,
/// which knew degrees alone.
///
/// Taken as they come, some with a note: headers of OpenSim and of SIMM (nRows and
/// nColumns, datacolumns and datarows), with anything else in them; LF, CRLF or CR; blank
/// lines; tabs or blanks; a time that is not the first column; counts that are not those
/// of the table; NaN and infinities in any spelling, as NaN.
///
/// Errors (kBadInput), with the line: no endheader; no time; a row with a cell too few or
/// too many; a cell that is no number; a time that runs backwards; vectors in cells.
/// Cost: linear in the text.
[[nodiscard]] Result<MotTable> parse_mot(std::string_view text, const std::string& file);

/// parse_mot() of the file at `path`.
[[nodiscard]] Result<MotTable> read_mot(const std::filesystem::path& path);

/// The text of a file as OpenSim 4 writes it, version 1, angles in degrees, which
/// parse_mot() reads as angles only where is_rotation(). Times, and values that are not
/// angles, are read again to the last bit, angles to 12 digits. Blanks in names of
/// columns become '.', infinities NaN.
/// Precondition: values has rows() * columns entries; times finite and not backwards.
[[nodiscard]] std::string mot_text(const MotTable& table);

/// Writes mot_text() to `path`, at once or not at all.
[[nodiscard]] Status write_mot(const std::filesystem::path& path, const MotTable& table);

}  // namespace marey::recordings
