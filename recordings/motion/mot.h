// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace marey::recordings {

struct MotColumn {
  std::string name;
  /// Angles are radians here (or radians per second) and degrees in the file. Other
  /// columns keep the file's numbers: metres, newtons or any other unit.
  bool is_angle = false;
};

/// Content of OpenSim's motion and storage files (.mot, .sto): columns against time.
struct MotTable {
  std::string name;                ///< The file's first line.
  std::vector<MotColumn> columns;  ///< Without the time.
  std::vector<double> time_s;      ///< Never decreases.
  /// Row by row; NaN where the file has NaN.
  std::vector<double> values;
  std::vector<std::string> notes;  ///< Anomalies of the file.

  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * columns.size() + column];
  }
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return values[row * columns.size() + column];
  }
  /// Returns the first column of this coordinate: its name, or that of its value in a
  /// file of states, "/jointset/hip_r/hip_flexion_r/value". Linear in columns.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view coordinate) const;
};

/// Returns true if OpenSim's whole-body models (Rajagopal2016, gait2392, gait2354,
/// Hamner, LaiArnold) have a rotation of this name, or a state of one.
/// `knee_angle_r_beta` is excluded: OpenSim always writes it in radians.
[[nodiscard]] bool is_rotation(std::string_view column);

/// Reads the text of a .mot or .sto file. `file` is its name in messages.
///
/// Only OpenSim's models define which columns are angles, so they are recognized by their
/// names (is_rotation()). They become radians if the file is in degrees: its header
/// contains inDegrees=yes, or neither that nor a version, as in files of SIMM, which only
/// has degrees.
///
/// Accepts the following, some with a note: headers of OpenSim and of SIMM (nRows and
/// nColumns, datacolumns and datarows), with other content in them; LF, CRLF or CR; blank
/// lines; tabs or blanks; a time that is not the first column; counts that differ from
/// the table; NaN and infinities in any spelling, as NaN.
///
/// Errors (kBadInput), with the line: no endheader; no time; a row with a missing or
/// additional cell; a cell that is no number; decreasing times; vectors in cells. Cost:
/// linear in the text.
[[nodiscard]] Result<MotTable> parse_mot(std::string_view text, const std::string& file);

/// Applies parse_mot() to the file at `path`.
[[nodiscard]] Result<MotTable> read_mot(const std::filesystem::path& path);

/// Returns the text of a file as OpenSim 4 writes it, version 1, angles in degrees.
/// parse_mot() reads as angles only the columns with is_rotation(). Times and values that
/// are not angles are read back exactly, angles to 12 digits. Blanks in column names
/// become '.', infinities NaN. Preconditions: values has rows() * columns entries; times
/// are finite and never decrease.
[[nodiscard]] std::string mot_text(const MotTable& table);

/// Writes mot_text() to `path`, as a whole or not at all.
[[nodiscard]] Status write_mot(const std::filesystem::path& path, const MotTable& table);

}  // namespace marey::recordings
