// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/base/lower_case.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/motion/mot.h"

namespace marey::recordings {
namespace {

/// Replaces every character that would end the line, or with `word` the cell.
std::string without_ends(std::string text, bool word) {
  for (char& c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ';
    if (word && blank) c = '.';
    if (!word && blank) c = ' ';
  }
  return text;
}

/// Returns the first line, the table's name, modified if it would read as a key of the
/// header.
std::string first_line(const MotTable& table) {
  const std::string name = without_ends(table.name, false);
  const std::size_t begin = name.find_first_not_of(' ');
  if (begin == std::string::npos) return "Coordinates";
  std::string line = name.substr(begin, name.find_last_not_of(' ') - begin + 1);
  std::string key = line.substr(0, line.find_first_of(" ="));
  for (char& c : key) c = lower_case(c);
  constexpr std::array<std::string_view, 11> kKeys{"name",
                                                   "nrows",
                                                   "datarows",
                                                   "nr",
                                                   "ncolumns",
                                                   "datacolumns",
                                                   "nc",
                                                   "version",
                                                   "indegrees",
                                                   "datatype",
                                                   "endheader"};
  const bool is_key = std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
  return is_key ? "name " + line : line;
}

void append_value(std::string& text, double value, bool is_angle) {
  const double in_file = is_angle ? value * kDegreesPerRadian : value;
  if (!std::isfinite(in_file)) {
    text += "NaN";
    return;
  }
  if (!is_angle) return append_exact(text, in_file);
  // The conversion to degrees rounds: more digits would not be read back exactly.
  std::array<char, 32> digits{};
  const auto [end, problem] = std::to_chars(digits.data(),
                                            digits.data() + digits.size(),
                                            in_file,
                                            std::chars_format::general,
                                            12);
  MAREY_ASSERT(problem == std::errc{});
  text.append(digits.data(), end);
}

}  // namespace

std::string mot_text(const MotTable& table) {
  MAREY_ASSERT(table.values.size() == table.rows() * table.columns.size());
  const bool angles = std::any_of(table.columns.begin(),
                                  table.columns.end(),
                                  [](const MotColumn& c) { return c.is_angle; });
  std::string text = first_line(table) + "\nversion=1\n";
  text += "nRows=" + std::to_string(table.rows()) + "\n";
  text += "nColumns=" + std::to_string(table.columns.size() + 1) + "\n";
  text += angles ? "inDegrees=yes\n" : "inDegrees=no\n";
  text += "\nUnits are S.I. units (second, meters, Newtons, ...)\n";
  if (angles) text += "Angles are in degrees.\n";
  text += "\nendheader\ntime";
  for (const MotColumn& column : table.columns) {
    text += '\t' + (column.name.empty() ? "." : without_ends(column.name, true));
  }
  text += '\n';
  double last_s = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    MAREY_ASSERT(std::isfinite(table.time_s[row]) && table.time_s[row] >= last_s);
    last_s = table.time_s[row];
    append_exact(text, last_s);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      text += '\t';
      append_value(text, table.at(row, i), table.columns[i].is_angle);
    }
    text += '\n';
  }
  return text;
}

Status write_mot(const std::filesystem::path& path, const MotTable& table) {
  return write_file(path, mot_text(table));
}

}  // namespace marey::recordings
