// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/degrees.h"
#include "core/base/in_quotes.h"
#include "core/base/lower_case.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/table_cells.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"
#include "recordings/motion/mot.h"

namespace marey::recordings {
namespace {

constexpr const char* kExport = "export the file again from OpenSim";

/// Rotations in the middle of the body, then those of each side: hip_flexion_r.
constexpr std::array<std::string_view, 6> kMiddle{"pelvis_tilt",
                                                  "pelvis_list",
                                                  "pelvis_rotation",
                                                  "lumbar_extension",
                                                  "lumbar_bending",
                                                  "lumbar_rotation"};
constexpr std::array<std::string_view, 14> kSided{"hip_flexion",
                                                  "hip_adduction",
                                                  "hip_rotation",
                                                  "knee_angle",
                                                  "ankle_angle",
                                                  "subtalar_angle",
                                                  "mtp_angle",
                                                  "arm_flex",
                                                  "arm_add",
                                                  "arm_rot",
                                                  "elbow_flex",
                                                  "pro_sup",
                                                  "wrist_flex",
                                                  "wrist_dev"};

/// Returns "hip_flexion_r" for "/jointset/hip_r/hip_flexion_r/value"; other names
/// unchanged.
std::string_view coordinate_of(std::string_view column, std::string_view state) {
  if (!column.starts_with('/') || !column.ends_with(state)) return column;
  column.remove_suffix(state.size());
  return column.substr(column.rfind('/') + 1);
}

struct Header {
  std::string name;
  std::optional<double> rows;
  std::optional<double> columns;
  std::optional<bool> in_degrees;
  bool has_version = false;

  [[nodiscard]] bool degrees() const { return in_degrees.value_or(!has_version); }
};

class MotReader {
 public:
  MotReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {}

  Result<MotTable> read() {
    if (Status ok = read_header(); !ok) return ok.error();
    if (Status ok = read_labels(); !ok) return ok.error();
    while (next_line()) {
      if (Status ok = read_row(); !ok) return ok.error();
    }
    table_.name = header_.name;
    note_counts();
    return std::move(table_);
  }

 private:
  [[nodiscard]] Error fail(const std::string& cause, const std::string& next) const {
    return bad_input(
        file_ + ":" + std::to_string(std::max(1, lines_.line())), cause, next);
  }

  /// Splits the next line that has cells.
  bool next_line() {
    while (const auto line = lines_.next()) {
      split_cells(*line, CellMark::kBlanks, cells_);
      if (!cells_.empty()) return true;
    }
    return false;
  }

  Status read_header() {
    for (bool first = true; const auto line = lines_.next();) {
      const std::string_view text = trimmed(*line);
      if (text.empty()) continue;
      const std::size_t end = std::min(text.find_first_of(" \t="), text.size());
      const std::string key = lower_case(text.substr(0, end));
      const std::size_t rest = text.find_first_not_of(" \t=", end);
      const std::string_view value =
          rest == std::string_view::npos ? std::string_view() : text.substr(rest);
      if (key == "endheader") return Done{};
      if (Status ok = read_key(key, value); !ok) return ok;
      if (first && key != "name") header_.name = text;
      first = false;
    }
    return fail("this is not a .mot or .sto file: there is no line endheader",
                "give a motion or storage file as OpenSim writes it");
  }

  Status read_key(const std::string& key, std::string_view value) {
    if (key == "name") {
      header_.name = value;
    } else if (key == "nrows" || key == "datarows" || key == "nr") {
      header_.rows = to_number(value);
    } else if (key == "ncolumns" || key == "datacolumns" || key == "nc") {
      header_.columns = to_number(value);
    } else if (key == "version") {
      header_.has_version = true;
    } else if (key == "indegrees") {
      const std::string word = lower_case(value);
      if (word != "yes" && word != "no" && word != "y" && word != "n") {
        return fail("inDegrees is " + in_quotes(value), "write yes or no there");
      }
      header_.in_degrees = word[0] == 'y';
    } else if (key == "datatype" && lower_case(value) != "double") {
      return fail("the cells hold " + in_quotes(value) + ", not single numbers",
                  "export the table flattened, one number to a cell");
    }
    return Done{};
  }

  Status read_labels() {
    if (!next_line()) return fail("the file ends after its header", kExport);
    const auto time = std::find_if(cells_.begin(), cells_.end(), [](std::string_view c) {
      return lower_case(c) == "time";
    });
    if (time == cells_.end()) {
      return fail("no column is called time; the columns begin with " +
                      in_quotes(cells_.front().substr(0, 40)),
                  "name the column of times \"time\", or export the file again");
    }
    time_column_ = static_cast<std::size_t>(time - cells_.begin());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (i == time_column_) continue;
      table_.columns.push_back({std::string(cells_[i]), is_rotation(cells_[i])});
    }
    return Done{};
  }

  Status read_row() {
    const std::size_t wanted = table_.columns.size() + 1;
    if (cells_.size() != wanted) {
      return fail("the row has " + std::to_string(cells_.size()) +
                      " numbers, and there " + "are " + std::to_string(wanted) +
                      " columns",
                  "correct the line, or export the file again");
    }
    for (std::size_t i = 0; i < wanted; ++i) {
      const auto value = number(cells_[i]);
      if (!value) {
        return fail(in_quotes(cells_[i].substr(0, 40)) + " is not a number",
                    "correct the line, or export the file again");
      }
      if (i == time_column_) {
        if (Status ok = add_time(*value); !ok) return ok;
        continue;
      }
      const MotColumn& column = table_.columns[i - (i > time_column_ ? 1 : 0)];
      const bool turn = column.is_angle && header_.degrees();
      table_.values.push_back(turn ? *value * kRadiansPerDegree : *value);
    }
    return Done{};
  }

  Status add_time(double time_s) {
    if (std::isnan(time_s)) return fail("the time is not a number", kExport);
    if (!table_.time_s.empty() && time_s < table_.time_s.back()) {
      return fail("the time runs backwards", "sort the rows by time");
    }
    table_.time_s.push_back(time_s);
    return Done{};
  }

  static std::optional<double> number(std::string_view cell) {
    if (const auto value = to_number(cell)) return value;
    if (is_missing(cell)) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
  }

  void note_counts() {
    const auto compare =
        [&](const std::optional<double>& declared, std::size_t there, const char* what) {
          if (!declared || *declared == static_cast<double>(there)) return;
          table_.notes.push_back("the header has another number of " + std::string(what) +
                                 " than there are, " + std::to_string(there));
        };
    compare(header_.rows, table_.rows(), "rows");
    compare(header_.columns, table_.columns.size() + 1, "columns");
  }

  LineReader lines_;
  const std::string& file_;
  Header header_;
  MotTable table_;
  std::size_t time_column_ = 0;
  std::vector<std::string_view> cells_;
};

}  // namespace

bool is_rotation(std::string_view column) {
  std::string_view name = coordinate_of(column, "/value");
  if (name == column) name = coordinate_of(column, "/speed");
  if (std::find(kMiddle.begin(), kMiddle.end(), name) != kMiddle.end()) return true;
  if (!name.ends_with("_r") && !name.ends_with("_l")) return false;
  name.remove_suffix(2);
  return std::find(kSided.begin(), kSided.end(), name) != kSided.end();
}

std::optional<std::size_t> MotTable::find(std::string_view coordinate) const {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (coordinate_of(columns[i].name, "/value") == coordinate) return i;
  }
  return std::nullopt;
}

Result<MotTable> parse_mot(std::string_view text, const std::string& file) {
  return MotReader(text, file).read();
}

Result<MotTable> read_mot(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_mot(*text, path.string());
}

}  // namespace marey::recordings
