// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the accuracy of gap filling: complete trials with artificial gaps.
//
//   measure_gaps ../shared/data/mocap/gaps WalkL_masks.csv
//   measure_gaps ../shared/data/mocap/gaps wild_masks.csv
//
// Prints per case the mean and the largest error over all samples of its gaps and the
// time on one core. Then prints the same figures over all cases; the share of errors
// within the 95 % region of their sigmas; and the error of linear interpolation.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "reconstruct/tracks/repair_gaps.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/csv_line.h"
#include "recordings/markers/marker_file.h"

namespace marey {
namespace {

struct Case {
  std::filesystem::path file;
  std::size_t first = 0;  ///< First frame of the file that is used.
  std::size_t end = 0;    ///< Frame after the last one used; 0: all.
  struct Gap {
    std::size_t marker, first, frames;
  };
  std::vector<Gap> gaps;
};

[[noreturn]] void stop(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

/// Reads the cases of a CSV file with one of two headers.
/// case,marker_index0,first_frame0,length: all cases are in WalkL.trc.
/// case,file,crop_first_frame0,crop_end_excl,marker_index0,label,
/// gap_first_frame0_in_crop,gap_len,seed: C3D files in mocaprecovery/, a sibling of the
/// folder.
std::map<std::string, Case> read_cases(const std::filesystem::path& folder,
                                       const std::string& masks) {
  const auto text = recordings::read_file(folder / masks);
  if (!text) stop(text.error().message());
  recordings::CsvLines lines(*text);
  const auto header = lines.next();
  if (!header) stop("no masks");
  const bool wild = header->find("crop") != std::string_view::npos;
  std::map<std::string, Case> cases;
  while (const auto line = lines.next()) {
    recordings::CsvFields fields(*line);
    Case& one = cases[std::string(fields.text())];
    Case::Gap gap{};
    if (wild) {
      one.file = folder / ".." / "mocaprecovery" / fields.text();
      one.first = fields.number<std::size_t>();
      one.end = fields.number<std::size_t>();
    } else {
      one.file = folder / "WalkL.trc";
    }
    gap.marker = fields.number<std::size_t>();
    if (wild) static_cast<void>(fields.text());
    gap.first = fields.number<std::size_t>();
    gap.frames = fields.number<std::size_t>();
    one.gaps.push_back(gap);
  }
  return cases;
}

MarkerTracks crop(const MarkerTracks& whole, std::size_t first, std::size_t end) {
  MarkerTracks part = whole;
  const std::size_t n = whole.markers();
  part.samples.assign(whole.samples.begin() + static_cast<std::ptrdiff_t>(first * n),
                      whole.samples.begin() + static_cast<std::ptrdiff_t>(end * n));
  return part;
}

double straight_error_m(const MarkerTracks& truth, const Case::Gap& gap, std::size_t i) {
  const std::size_t after = gap.first + gap.frames;
  const std::size_t from = gap.first > 0 ? gap.first - 1 : after;
  const std::size_t to = after < truth.frames() ? after : from;
  const glm::dvec3& a = truth.at(from, gap.marker)->p_in_world;
  const glm::dvec3& b = truth.at(to, gap.marker)->p_in_world;
  const double share = to > from ? static_cast<double>(gap.first + i - from) /
                                       static_cast<double>(to - from)
                                 : 0.0;
  return glm::distance(a + share * (b - a),
                       truth.at(gap.first + i, gap.marker)->p_in_world);
}

struct Figures {
  std::vector<double> mean_mm;
  std::vector<double> worst_mm;
  std::vector<double> seconds;
  std::vector<double> straight_mm;
  long within = 0;
  long samples = 0;
  long empty = 0;
};

void measure(const std::string& name,
             const Case& one,
             const MarkerTracks& truth,
             Figures& figures) {
  MarkerTracks holed = truth;
  for (const Case::Gap& gap : one.gaps) {
    for (std::size_t i = 0; i < gap.frames; ++i) {
      holed.at(gap.first + i, gap.marker).reset();
    }
  }
  // Measures processor time instead of wall-clock time: other programs may be running.
  const std::clock_t start = std::clock();
  const auto repaired = reconstruct::repair_gaps(holed);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  double sum_m = 0.0;
  double straight_m = 0.0;
  double worst_m = 0.0;
  int samples = 0;
  for (const Case::Gap& gap : one.gaps) {
    for (std::size_t i = 0; i < gap.frames; ++i) {
      const auto& found = repaired.tracks.at(gap.first + i, gap.marker);
      const auto& real = truth.at(gap.first + i, gap.marker);
      if (!real) continue;
      if (!found) {
        ++figures.empty;
        continue;
      }
      const double error_m = glm::distance(found->p_in_world, real->p_in_world);
      const double sigmas = error_m / static_cast<double>(found->sigma_m);
      // 95 % of a chi square distribution with three degrees of freedom.
      if (sigmas * sigmas < 7.815) ++figures.within;
      ++samples;
      sum_m += error_m;
      worst_m = std::max(worst_m, error_m);
      straight_m += straight_error_m(truth, gap, i);
    }
  }
  figures.samples += samples;
  figures.mean_mm.push_back(1e3 * sum_m / samples);
  figures.worst_mm.push_back(1e3 * worst_m);
  figures.straight_mm.push_back(1e3 * straight_m / samples);
  figures.seconds.push_back(seconds);
  std::printf("%-12s %6d samples: mean %6.2f mm, worst %6.1f mm, %.2f s\n",
              name.c_str(),
              samples,
              figures.mean_mm.back(),
              figures.worst_mm.back(),
              seconds);
}

double average(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

void print(const std::string& name, const Figures& figures) {
  std::printf(
      "%s: %zu cases; mean error per case: mean %.2f, median %.2f, p95 %.2f, worst %.2f "
      "mm; largest of all %.0f mm; straight lines %.0f mm; within 95 %% of sigma: %.1f "
      "%%; left empty %ld; time median %.2f, worst %.2f s\n",
      name.c_str(),
      figures.mean_mm.size(),
      average(figures.mean_mm),
      median(figures.mean_mm),
      quantile(figures.mean_mm, 0.95),
      quantile(figures.mean_mm, 1.0),
      quantile(figures.worst_mm, 1.0),
      average(figures.straight_mm),
      100.0 * static_cast<double>(figures.within) / static_cast<double>(figures.samples),
      figures.empty,
      median(figures.seconds),
      quantile(figures.seconds, 1.0));
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  using namespace marey;
  if (argc != 3) stop("usage: measure_gaps FOLDER MASKS.csv");
  std::map<std::filesystem::path, MarkerTracks> files;
  std::map<std::string, Figures> groups;
  for (const auto& [name, one] : read_cases(argv[1], argv[2])) {
    if (!files.contains(one.file)) {
      auto read = recordings::read_markers(one.file);
      if (!read) stop(read.error().message());
      files[one.file] = std::move(read->tracks);
    }
    const MarkerTracks& whole = files.at(one.file);
    const std::size_t end = one.end == 0 ? whole.frames() : one.end;
    // Wild cases have names like FILE_A0 and form three groups.
    const bool wild = one.end != 0;
    measure(name,
            one,
            crop(whole, one.first, end),
            groups[wild ? std::string(1, name.at(name.size() - 2)) : "all"]);
  }
  for (const auto& [name, figures] : groups) print(name, figures);
  return 0;
}
