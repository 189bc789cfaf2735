// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/trc_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/base/assert.h"
#include "core/base/lower_case.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"

namespace marey::recordings {
namespace {

/// Splits a line and drops blank cells: the header's lines are short, and some programs
/// separate their cells by two tabs or by blanks.
void split_filled(std::string_view line, std::vector<std::string_view>& cells) {
  const CellMark mark = cell_mark(line);
  split_cells(line, mark == CellMark::kTab ? CellMark::kBlanks : mark, cells);
  std::erase(cells, std::string_view());
}

std::optional<int> count_of(std::string_view word) {
  const auto value = to_number(word);
  if (!value || *value < 0.0 || *value > 1e9) return std::nullopt;
  return static_cast<int>(*value);
}

/// Assigns the values of the third line to the names of the second line. Blank cells are
/// skipped; the unit, the only word that is no number, may be missing.
void read_values(const std::vector<std::string_view>& keys,
                 const std::vector<std::string_view>& values,
                 TrcHeader& header) {
  std::size_t value = 0;
  for (const std::string_view key : keys) {
    if (value == values.size()) return;
    const std::string_view word = values[value];
    const std::string name = lower_case(key);
    if (name == "units") {
      if (to_number(word)) continue;
      header.unit = word;
    } else if (name == "datarate" || (name == "camerarate" && !header.rate_hz)) {
      const auto hz = to_number(word);
      if (hz && *hz >= kMinRateHz && *hz <= 10.0 * kMaxRateHz) header.rate_hz = hz;
    } else if (name == "numframes") {
      header.frames = count_of(word);
    } else if (name == "nummarkers") {
      header.markers = count_of(word);
    }
    ++value;
  }
}

/// Returns the labels, each above the first of its three columns. Some programs shift
/// them all by one tab, and some leave one blank.
std::vector<std::string> labels_of(const std::vector<std::string_view>& cells,
                                   const std::optional<int>& declared) {
  std::vector<std::string> labels;
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    columns.push_back(i);
    labels.emplace_back(cells[i]);
  }
  // The first two columns are the frame and the time.
  constexpr std::size_t kOthers = 2;
  if (columns.size() <= kOthers) return {};
  labels.erase(labels.begin(), labels.begin() + kOthers);
  columns.erase(columns.begin(), columns.begin() + kOthers);
  const auto count = static_cast<std::size_t>(std::max(0, declared.value_or(0)));
  if (labels.size() >= count) return labels;
  // Fewer labels than markers: blank labels have an empty column of their own.
  std::vector<std::string> placed;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if ((columns[i] - columns[0]) % 3 != 0) return labels;
    placed.resize((columns[i] - columns[0]) / 3 + 1);
    placed.back() = labels[i];
  }
  // Limited by the header's number of markers, because empty cells cost a file few bytes.
  return placed.size() <= count ? placed : labels;
}

std::string hz_text(double hz) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g Hz", hz);
  return text.data();
}

/// Returns the rate of the Time column, or nullopt if there is none.
std::optional<double> rate_of_times(const std::vector<double>& numbers,
                                    const std::vector<double>& times_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double frames = numbers[i] - numbers[i - 1];
    if (frames >= 1.0) steps.push_back((times_s[i] - times_s[i - 1]) / frames);
  }
  if (steps.empty()) return std::nullopt;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double hz = 1.0 / *middle;
  if (!(hz >= kMinRateHz && hz <= 10.0 * kMaxRateHz)) return std::nullopt;
  const double whole = std::round(hz);
  return std::abs(hz - whole) < 1e-3 * hz ? whole : hz;
}

/// Returns true if the rows' times match frames at this rate, within the precision of
/// their few digits.
bool is_rate_of(double rate_hz,
                const std::vector<double>& numbers,
                const std::vector<double>& times_s) {
  const double frames = numbers.back() - numbers.front();
  const double time_s = times_s.back() - times_s.front();
  if (!(frames >= 1.0) || !(time_s > 0.0)) return true;
  return std::abs(frames / time_s - rate_hz) <= 0.02 * rate_hz;
}

}  // namespace

Result<TrcHeader> read_trc_header(LineReader& lines, const std::string& file) {
  const auto fail = [&](const std::string& cause) {
    return bad_input(file + ":" + std::to_string(std::max(1, lines.line())),
                     cause,
                     "give a TRC file as OpenSim, Cortex or Vicon write it");
  };
  const auto first = lines.next();
  if (!first || !lower_case(trimmed(*first)).starts_with("pathfiletype")) {
    return fail("this is not a TRC file: it does not begin with PathFileType");
  }
  TrcHeader header;
  std::vector<std::string_view> keys;
  std::vector<std::string_view> values;
  const auto names = lines.next();
  if (!names) return fail("the file ends in its header");
  split_filled(*names, keys);
  if (keys.empty() || lower_case(keys[0]) != "datarate") {
    return fail("expected DataRate, CameraRate, NumFrames...");
  }
  const auto numbers = lines.next();
  if (!numbers) return fail("the file ends in its header");
  split_filled(*numbers, values);
  read_values(keys, values, header);

  auto labels = lines.next();
  while (labels && trimmed(*labels).empty()) labels = lines.next();
  if (!labels) return fail("the file ends in its header");
  header.mark = cell_mark(*labels);
  std::vector<std::string_view> cells;
  split_cells(*labels, header.mark, cells);
  if (!lower_case(trimmed(*labels)).starts_with("frame")) {
    return fail("expected Frame#, Time and the markers' labels");
  }
  header.labels = labels_of(cells, header.markers);
  return header;
}

FileAxes trc_axes(const TrcHeader& header,
                  const AxisFinder& finder,
                  const MarkerReadOptions& options,
                  std::vector<std::string>& notes) {
  FileAxes axes;
  const auto set = [&](const std::string& unit, Evidence from) {
    axes.unit = unit;
    axes.per_metre = units_per_metre(unit).value_or(1000.0);
    axes.unit_from = from;
  };
  if (options.unit) {
    MAREY_ASSERT(units_per_metre(*options.unit).has_value());
    set(*options.unit, Evidence::kUser);
  } else if (units_per_metre(header.unit)) {
    set(header.unit, Evidence::kFile);
  } else if (const auto found = finder.unit()) {
    set(*found, Evidence::kMarkers);
    notes.push_back(
        "Units names no unit of length; estimated from the markers' distances it is " +
        *found);
  } else {
    set("mm", Evidence::kConvention);
    notes.emplace_back("Units names no unit of length; mm is used, as in most TRC files");
  }
  if (options.up) {
    axes.up = *options.up;
    axes.up_from = Evidence::kUser;
    return axes;
  }
  axes.up = FileAxis::kPlusY;
  axes.up_from = Evidence::kConvention;
  const auto found = finder.up();
  if (found) {
    axes.up = *found;
    axes.up_from = Evidence::kMarkers;
  }
  if (!found) {
    notes.emplace_back(
        "the markers' positions do not determine which axis is up; +Y is used, as in "
        "most TRC files");
  } else if (*found != FileAxis::kPlusY) {
    notes.push_back("from the markers' positions, " + std::string(name(*found)) +
                    " is up");
  }
  return axes;
}

Result<TrcFrames> place_trc_rows(const TrcHeader& header,
                                 const std::vector<double>& numbers,
                                 const std::vector<double>& times_s,
                                 const std::string& file,
                                 int last_line,
                                 std::vector<std::string>& notes) {
  MAREY_ASSERT(numbers.size() == times_s.size());
  TrcFrames frames;
  const auto timed = rate_of_times(numbers, times_s);
  if (header.rate_hz) {
    frames.rate_hz = *header.rate_hz;
    if (timed && !is_rate_of(*header.rate_hz, numbers, times_s)) {
      frames.rate_hz = *timed;
      if (hz_text(*header.rate_hz) == hz_text(*timed)) {
        notes.push_back("the times are not even: a constant rate is assumed, " +
                        hz_text(*timed) + " all along");
      } else {
        notes.push_back("DataRate is " + hz_text(*header.rate_hz) + ", the times " +
                        hz_text(*timed) + "; the times are used");
      }
    }
  } else if (timed) {
    frames.rate_hz = *timed;
    notes.push_back("there is no DataRate; by the times it is " + hz_text(*timed));
  } else if (times_s.size() <= 1) {
    frames.rate_hz = 1.0;
    notes.emplace_back("there is no frame rate, and one frame needs none");
  } else {
    return bad_input(file + ":3",
                     "neither DataRate nor the times give a frame rate",
                     "set DataRate, in Hz");
  }
  if (times_s.empty()) return frames;
  if (std::abs(numbers[0]) < 1e9) frames.first_frame = static_cast<int>(numbers[0]);

  std::size_t left_out = 0;
  frames.frame_of_row.push_back(0);
  for (std::size_t row = 1; row < numbers.size(); ++row) {
    double jump = numbers[row] - numbers[row - 1];
    const double time_jump = (times_s[row] - times_s[row - 1]) * frames.rate_hz;
    // A jump of the frame number without a matching jump of the time is an error of the
    // file.
    if (!(jump >= 1.0) || std::abs(jump - time_jump) > 0.5) jump = 1.0;
    jump = std::round(jump);
    if (jump - 1.0 >
        10.0 * static_cast<double>(numbers.size()) - static_cast<double>(left_out)) {
      return bad_input(file + ":" + std::to_string(last_line),
                       "the file skips more than ten times as many frames as it has",
                       "cut the recording at its gap");
    }
    left_out += static_cast<std::size_t>(jump) - 1;
    frames.frame_of_row.push_back(frames.frame_of_row.back() +
                                  static_cast<std::size_t>(jump));
  }
  frames.count = frames.frame_of_row.back() + 1;
  if (left_out > 0) {
    notes.push_back(std::to_string(left_out) +
                    " frames are missing in the file; they are kept as frames without "
                    "markers");
  }
  return frames;
}

}  // namespace marey::recordings
