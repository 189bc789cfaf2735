// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/sessions/session_rows.h"

#include <algorithm>
#include <istream>
#include <ostream>
#include <sstream>

namespace marey::benchmarks {
namespace {

using testing::Tally;

/// Commas separate; texts do without.
std::string plain(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream in(line);
  std::string cell;
  while (std::getline(in, cell, ',')) cells.push_back(cell);
  return cells;
}

/// Takes the cells of a row in turn.
class Cells {
 public:
  explicit Cells(std::vector<std::string> cells) : cells_(std::move(cells)) {}
  std::string text() { return next_ < cells_.size() ? cells_[next_++] : std::string(); }
  double number() {
    std::istringstream in(text());
    double value = 0.0;
    in >> value;
    return value;
  }
  int integer() { return static_cast<int>(number()); }

 private:
  std::vector<std::string> cells_;
  std::size_t next_ = 0;
};

}  // namespace

void write_header(std::ostream& out) {
  out << "seed,refused,sufficient,silently_wrong,spike_frames,flipped_frames,median_m,"
         "p95_m,max_m,lengths,lengths_inside,worst_length_share,cameras,fit_s,solve_s,";
  for (const char* source : {"measured", "repaired", "inferred"}) {
    for (const char* joint : {"shoulder", "elbow", "wrist", "hip", "knee", "ankle"}) {
      out << source << '_' << joint << ',' << source << '_' << joint << "_inside,";
    }
  }
  out << "refused_by,message_class,lacking,causes,left_out,session\n";
}

void write_row(std::ostream& out, const SessionRow& row) {
  const testing::SessionVerdict& v = row.verdict;
  out << row.seed << ',' << v.is_refused << ',' << row.is_sufficient << ','
      << v.is_silently_wrong << ',' << v.spike_frames << ',' << v.flipped_frames << ','
      << v.median_m << ',' << v.p95_m << ',' << v.max_m << ',' << v.lengths.count << ','
      << v.lengths.inside << ',' << v.worst_length_share << ',' << row.cameras << ','
      << row.fit_s << ',' << row.solve_s << ',';
  for (const auto& joints : v.honest) {
    for (const Tally& tally : joints) out << tally.count << ',' << tally.inside << ',';
  }
  out << plain(row.refused_by) << ',' << plain(row.message_class) << ','
      << plain(row.lacking) << ',' << plain(row.causes) << ',' << plain(row.left_out)
      << ',' << plain(row.session) << std::endl;
}

std::optional<std::vector<SessionRow>> read_rows(std::istream& in) {
  std::string line;
  if (!std::getline(in, line) || !line.starts_with("seed,")) return std::nullopt;
  std::vector<SessionRow> rows;
  while (std::getline(in, line)) {
    Cells cells(cells_of(line));
    SessionRow row;
    testing::SessionVerdict& v = row.verdict;
    row.seed = static_cast<std::uint64_t>(cells.number());
    v.is_refused = cells.integer() != 0;
    row.is_sufficient = cells.integer() != 0;
    v.is_silently_wrong = cells.integer() != 0;
    v.spike_frames = cells.integer();
    v.flipped_frames = cells.integer();
    v.median_m = cells.number();
    v.p95_m = cells.number();
    v.max_m = cells.number();
    v.lengths.count = cells.integer();
    v.lengths.inside = cells.integer();
    v.worst_length_share = cells.number();
    row.cameras = cells.integer();
    row.fit_s = cells.number();
    row.solve_s = cells.number();
    for (auto& joints : v.honest) {
      for (Tally& tally : joints) {
        tally.count = cells.integer();
        tally.inside = cells.integer();
      }
    }
    row.refused_by = cells.text();
    row.message_class = cells.text();
    row.lacking = cells.text();
    row.causes = cells.text();
    row.left_out = cells.text();
    v.is_partial = !row.left_out.empty() && !v.is_refused && !v.is_silently_wrong;
    row.session = cells.text();
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace marey::benchmarks
