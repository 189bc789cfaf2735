// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/other_kind.h"
#include "recordings/base/table_cells.h"
#include "recordings/base/text_reader.h"
#include "recordings/markers/marker_labels.h"
#include "recordings/markers/trc.h"
#include "recordings/markers/trc_header.h"

namespace marey::recordings {
namespace {

/// A row, whose samples are in Rows::samples.
struct RowTime {
  double frame = 0.0;
  double time_s = 0.0;
};

/// The rows of a file, in its frame and unit.
class Rows {
 public:
  /// Limits the samples to `maximum`: rows may be short, and labels many.
  Rows(LineReader& lines,
       TrcHeader& header,
       const std::string& file,
       std::size_t max_samples,
       MarkerFile& out)
      : lines_(lines),
        header_(header),
        file_(file),
        max_samples_(max_samples),
        out_(out) {}

  Status read() {
    bool first = true;
    while (const auto line = lines_.next()) {
      split_cells(*line, header_.mark, cells_);
      present_ = cells_.size();
      while (!cells_.empty() && cells_.back().empty()) cells_.pop_back();
      if (cells_.empty()) continue;
      // The row X1 Y1 Z1..., which some files omit.
      if (first && !header_.has_axes_row && is_axes_row()) {
        header_.has_axes_row = true;
        continue;
      }
      if (std::exchange(first, false)) {
        settle_markers();
      }
      if (Status ok = row(); !ok) return ok;
    }
    if (first)
      header_.labels = distinct_labels(header_.labels, header_.labels.size(), notes());
    return Done{};
  }

  std::vector<RowTime> times;
  std::vector<std::optional<glm::dvec3>> samples;

  void note_counts() {
    const auto note_count = [&](const char* what, std::size_t count) {
      if (count > 0) notes().push_back(what + (": " + std::to_string(count)));
    };
    note_count("positions that are exactly 0, 0, 0 and count as not seen", zeros_);
    note_count("positions that lack a coordinate and count as not seen", partial_);
    note_count("rows that end before the last marker; the rest counts as not seen",
               short_);
    note_count("numbers with a comma for a decimal point", commas_);
    note_count("positions beyond 10 km that count as not seen", far_);
    const auto declared = header_.frames;
    if (declared && static_cast<std::size_t>(*declared) != times.size()) {
      notes().push_back("the header states " + std::to_string(*declared) +
                        " frames, and there are " + std::to_string(times.size()));
    }
  }

  /// Positions beyond 10 km are mistakes, or one vendor's mark for "not seen".
  void leave_out_far(double per_metre) {
    for (std::optional<glm::dvec3>& p : samples) {
      if (!p) continue;
      const double furthest = kMaxDistance_m * per_metre;
      if (std::abs(p->x) <= furthest && std::abs(p->y) <= furthest &&
          std::abs(p->z) <= furthest) {
        continue;
      }
      p.reset();
      ++far_;
    }
  }

 private:
  std::vector<std::string>& notes() { return out_.notes; }

  [[nodiscard]] Error fail(const std::string& cause) const {
    return bad_input(file_ + ":" + std::to_string(lines_.line()),
                     cause,
                     "correct the line, or export the file again");
  }

  [[nodiscard]] bool is_axes_row() const {
    const auto filled = std::find_if(
        cells_.begin(), cells_.end(), [](std::string_view c) { return !c.empty(); });
    return filled != cells_.end() && !to_number(*filled) && !is_missing(*filled) &&
           (filled->front() == 'X' || filled->front() == 'x');
  }

  /// Labels, header and rows may have three different numbers of markers.
  void settle_markers() {
    const std::size_t in_row = (std::max<std::size_t>(widest_row(), 2) - 2 + 2) / 3;
    const std::size_t named = header_.labels.size();
    const auto declared =
        static_cast<std::size_t>(std::max(0, header_.markers.value_or(0)));
    std::size_t count = named;
    if (in_row > named && in_row <= declared) count = in_row;
    // Cortex also lists the names of its virtual markers, without writing their
    // positions.
    if (declared > 0 && in_row <= declared && declared < named) count = declared;
    if (declared != count && header_.markers) {
      notes().push_back("the header states " + std::to_string(declared) +
                        " markers, and there are " + std::to_string(count));
    }
    header_.labels = distinct_labels(std::move(header_.labels), count, notes());
  }

  /// Returns the cells of the widest remaining row, without blank ones at its end.
  [[nodiscard]] std::size_t widest_row() const {
    std::size_t widest = cells_.size();
    LineReader ahead = lines_;
    std::vector<std::string_view> cells;
    while (const auto line = ahead.next()) {
      split_cells(*line, header_.mark, cells);
      while (!cells.empty() && cells.back().empty()) cells.pop_back();
      widest = std::max(widest, cells.size());
    }
    return widest;
  }

  Status row() {
    const std::size_t max_cells = 2 + 3 * header_.labels.size();
    if (cells_.size() > max_cells) {
      return fail("the row has " + std::to_string(cells_.size()) + " cells; a frame, a " +
                  "time and " + std::to_string(header_.labels.size()) +
                  " markers have room for " + std::to_string(max_cells));
    }
    if (cells_.size() < max_cells && header_.mark == CellMark::kBlanks) {
      return fail("the row has " + std::to_string(cells_.size()) +
                  " numbers instead of " + std::to_string(max_cells));
    }
    const auto frame = number(0, "a frame's number");
    if (!frame) return frame.error();
    const auto time = cells_.size() < 2 ? Result<std::optional<double>>(std::nullopt)
                                        : number(1, "a time");
    if (!time) return time.error();
    RowTime at;
    at.frame = frame->value_or(times.empty() ? 1.0 : times.back().frame + 1.0);
    at.time_s = time->value_or(times.empty() ? 0.0 : times.back().time_s);
    if (!times.empty() && at.time_s < times.back().time_s) {
      return fail("the time runs backwards");
    }
    times.push_back(at);
    if (samples.size() + header_.labels.size() > max_samples_) {
      return fail("so many rows, of so few cells, do not fit into memory");
    }
    if (present_ < max_cells) ++short_;
    for (std::size_t marker = 0; marker < header_.labels.size(); ++marker) {
      if (Status ok = position(marker); !ok) return ok;
    }
    return Done{};
  }

  Status position(std::size_t marker) {
    glm::dvec3 p(0.0);
    int missing = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t cell = 2 + 3 * marker + i;
      const auto value = cell < cells_.size()
                             ? number(cell, "a coordinate")
                             : Result<std::optional<double>>(std::nullopt);
      if (!value) return value.error();
      if (*value) {
        p[static_cast<int>(i)] = **value;
      } else {
        ++missing;
      }
    }
    const bool zero = missing == 0 && p == glm::dvec3(0.0);
    if (zero) ++zeros_;
    if (missing == 1 || missing == 2) ++partial_;
    samples.push_back(missing > 0 || zero ? std::nullopt : std::optional(p));
    return Done{};
  }

  /// Returns the number in a cell; nullopt if it is missing.
  Result<std::optional<double>> number(std::size_t cell, const char* what) {
    const std::string_view text = cells_[cell];
    if (is_missing(text)) return std::optional<double>();
    if (const auto value = to_number(text)) return value;
    if (header_.mark != CellMark::kComma &&
        std::count(text.begin(), text.end(), ',') == 1) {
      std::string pointed(text);
      pointed[pointed.find(',')] = '.';
      if (const auto value = to_number(pointed)) {
        ++commas_;
        return value;
      }
    }
    const std::string shown(text.substr(0, 40));
    return fail("column " + std::to_string(cell + 1) + ", " + what + ": " +
                in_quotes(shown) + " is not a number");
  }

  LineReader& lines_;
  TrcHeader& header_;
  const std::string& file_;
  std::size_t max_samples_;
  MarkerFile& out_;
  std::vector<std::string_view> cells_;
  std::size_t present_ = 0;  ///< Cells of the row, including blank ones at its end.
  std::size_t zeros_ = 0;
  std::size_t partial_ = 0;
  std::size_t short_ = 0;
  std::size_t commas_ = 0;
  std::size_t far_ = 0;
};

}  // namespace

Result<MarkerFile> parse_trc(std::string_view text,
                             const std::string& file,
                             const MarkerReadOptions& options) {
  if (const Status ok = check_kind(text, file, kTrcKind); !ok) return ok.error();
  MarkerFile out;
  LineReader lines(text);
  Result<TrcHeader> header = read_trc_header(lines, file);
  if (!header) return header.error();
  // A marker that is not seen takes three tabs; rows may also end early.
  const std::size_t max_samples = 1'000'000 + text.size();
  Rows rows(lines, *header, file, max_samples, out);
  if (Status ok = rows.read(); !ok) return ok.error();

  AxisFinder finder;
  const std::size_t markers = header->labels.size();
  std::vector<glm::dvec3> seen;
  const std::size_t step = std::max<std::size_t>(1, rows.times.size() / 500);
  for (std::size_t row = 0; row < rows.times.size() && markers > 0; row += step) {
    seen.clear();
    for (std::size_t m = 0; m < markers; ++m) {
      if (const auto& p = rows.samples[row * markers + m]) seen.push_back(*p);
    }
    finder.add_frame(seen);
  }
  out.axes = trc_axes(*header, finder, options, out.notes);
  rows.leave_out_far(out.axes.per_metre);
  rows.note_counts();

  std::vector<double> numbers;
  std::vector<double> times;
  for (const RowTime& at : rows.times) {
    numbers.push_back(at.frame);
    times.push_back(at.time_s);
  }
  const Result<TrcFrames> frames =
      place_trc_rows(*header, numbers, times, file, lines.line(), out.notes);
  if (!frames) return frames.error();
  if (markers > 0 && frames->count > 10 * max_samples / markers) {
    return bad_input(file + ":" + std::to_string(lines.line()),
                     "the file skips so many frames that the result does not fit into "
                     "memory",
                     "cut the recording at its gap");
  }
  MarkerTracks& tracks = out.tracks;
  tracks.labels = std::move(header->labels);
  tracks.rate = FrameRate{frames->rate_hz};
  tracks.first_frame = frames->first_frame;
  tracks.start_s = times.empty() ? 0.0 : times[0];
  tracks.samples.resize(frames->count * markers);
  for (std::size_t row = 0; row < frames->frame_of_row.size(); ++row) {
    for (std::size_t m = 0; m < markers; ++m) {
      const auto& p = rows.samples[row * markers + m];
      if (!p) continue;
      MarkerSample sample;
      sample.p_in_world = turned_to_world(out.axes.up, *p / out.axes.per_metre);
      tracks.at(frames->frame_of_row[row], m) = sample;
    }
  }
  return out;
}

}  // namespace marey::recordings
