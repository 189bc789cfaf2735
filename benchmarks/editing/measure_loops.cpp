// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures loops made of captured motions (edit/ops/cyclify.h), over ten cycles.
//
//   measure_loops ../shared/data/mocap/cmu_asfamc/02_01.amc WALKS...
//   measure_loops --summary WALKS...
//   measure_loops --time
//
// Prints one row per motion, and the medians and counts over all. With --summary only
// these. With --time: the time to search 60 s at 30 Hz.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "edit/find/find_loops.h"

#include "app/motion/retarget_files.h"
#include "benchmarks/editing/loop_figures.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey {
namespace {

constexpr double kMaxSlide_cm_per_s = 0.3;
constexpr double kMaxPeriodError = 0.05;

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

ResultTable row_table(const std::vector<LoopRow>& rows) {
  ResultTable table;
  table.id = "loops";
  table.title = "Best loop of each motion, straight, ten cycles";
  table.columns = {{"motion"},      {"period s", 3},   {"strikes s", 3}, {"gap mm", 0},
                   {"plain mm", 0}, {"worst mm", 0},   {"median mm", 0}, {"dv m/s", 2},
                   {"plain dv", 2}, {"turn deg", 1},   {"travel m", 2},  {"a cut", 0},
                   {"cut p95", 0},  {"a seam", 0},     {"a p95", 0},     {"jump m/s", 2},
                   {"jump p95", 2}, {"slide cm/s", 1}, {"looped", 3},    {"drift mm", 6},
                   {"moved mm", 0}, {"find ms", 1},    {"op ms", 0}};
  for (const LoopRow& r : rows) {
    table.rows.push_back({r.name,
                          r.period_s,
                          r.strikes_s ? TableCell(*r.strikes_s) : TableCell("-"),
                          r.gap_mm,
                          r.plain_mm,
                          r.worst_mm,
                          r.median_mm,
                          r.velocity_gap,
                          r.plain_velocity_gap,
                          r.turn_deg,
                          r.travel_m,
                          r.cut_acceleration,
                          r.cut_inside,
                          r.seam_acceleration,
                          r.inside_acceleration,
                          r.seam_jump,
                          r.inside_jump,
                          r.slide_source,
                          r.slide_loop,
                          1e3 * r.drift_m,
                          r.displaced_mm,
                          r.find_ms,
                          r.all_ms});
  }
  table.notes = {
      "period s: length of the loop; strikes s: mean of both feet's time between strikes, "
      "around "
      "the middle of the loop",
      "gap, worst: joints at the ends of the cycle, weighted rms and largest, before "
      "correction; dv: rms of velocities; plain: all joints alike; median: the same, of "
      "all "
      "pairs of frames",
      "acceleration a, m/s^2: largest of a joint at the seam, as cut and after; p95: "
      "of all other frames",
      "jump: velocity before the seam against after it, by cubics through 4 frames on "
      "either side; p95: the same at all other frames",
      "slide, looped: mean speed of bearing joints before and after; drift: copies "
      "against the first moved by whole travels"};
  return table;
}

double median_of(const std::vector<LoopRow>& rows, double (*value)(const LoopRow&)) {
  std::vector<double> values;
  for (const LoopRow& row : rows) values.push_back(value(row));
  return quantile(values, 0.5);
}

void print_summary(const std::vector<LoopRow>& rows,
                   const std::map<std::string, int>& refusals) {
  int refused = 0;
  for (const auto& [cause, count] : refusals) {
    std::printf("refused %3d: %s\n", count, cause.c_str());
    refused += count;
  }
  std::printf("looped  %3d of %d\n",
              static_cast<int>(rows.size()),
              static_cast<int>(rows.size()) + refused);
  if (rows.empty()) return;
  const auto count = [&](const char* what, auto fails) {
    std::printf("  %-58s %3d\n",
                what,
                static_cast<int>(std::count_if(rows.begin(), rows.end(), fails)));
  };
  count("seam acceleration above the inside's p95",
        [](const LoopRow& r) { return r.seam_acceleration > r.inside_acceleration; });
  count("velocity jump above the inside's p95",
        [](const LoopRow& r) { return r.seam_jump > r.inside_jump; });
  count("slide above 0.3 cm/s",
        [](const LoopRow& r) { return r.slide_loop > kMaxSlide_cm_per_s; });
  count("drift above 1e-6 m", [](const LoopRow& r) { return r.drift_m > 1e-6; });
  count("period off the strikes' by more than 5 %", [](const LoopRow& r) {
    return r.strikes_s && std::abs(r.period_s / *r.strikes_s - 1.0) > kMaxPeriodError;
  });
  count("period changed by more than 1 %",
        [](const LoopRow& r) { return std::abs(r.change_percent) > 1.0; });
  const auto median = [&](const char* what, double (*value)(const LoopRow&)) {
    std::printf("  median %-51s %.3g\n", what, median_of(rows, value));
  };
  median("gap, mm", [](const LoopRow& r) { return r.gap_mm; });
  median("gap of all pairs, mm", [](const LoopRow& r) { return r.median_mm; });
  median("velocity gap, m/s", [](const LoopRow& r) { return r.velocity_gap; });
  median("period against the strikes', %", [](const LoopRow& r) {
    return r.strikes_s ? 100.0 * std::abs(r.period_s / *r.strikes_s - 1.0) : 0.0;
  });
  median("seam acceleration as cut, over the inside's p95",
         [](const LoopRow& r) { return r.cut_acceleration / r.inside_acceleration; });
  median("seam acceleration, over the inside's p95",
         [](const LoopRow& r) { return r.seam_acceleration / r.inside_acceleration; });
  median("slide of the source, cm/s", [](const LoopRow& r) { return r.slide_source; });
  median("slide of the loop, cm/s", [](const LoopRow& r) { return r.slide_loop; });
}

// The refusal without its numbers.
std::string cause_of(const Error& error) {
  for (const char* cause : {"not cyclic", "do not repeat", "stand on the same feet"}) {
    if (error.cause.find(cause) != std::string::npos) return cause;
  }
  return error.cause;
}

void measure_time() {
  const auto walk = testing::synthetic_walk(1800, 30.0, 0.01, 0.002);
  const auto state = edit::make_edit_state(walk.motion);
  if (!state) return;
  std::vector<double> narrow, wide, map;
  for (int n = 0; n < 7; ++n) {
    auto start = Clock::now();
    (void)edit::find_loops(*state);
    narrow.push_back(milliseconds_since(start));
    start = Clock::now();
    edit::FindLoopsOptions all;
    all.min_period_s = 0.3;
    all.max_period_s = 59.0;
    (void)edit::find_loops(*state, all);
    wide.push_back(milliseconds_since(start));
    start = Clock::now();
    (void)edit::loop_map(*state);
    map.push_back(milliseconds_since(start));
  }
  std::printf(
      "60 s at 30 Hz, median of 7: default periods %.1f ms, all pairs %.0f ms, "
      "map %.0f ms\n",
      quantile(narrow, 0.5),
      quantile(wide, 0.5),
      quantile(map, 0.5));
}

int run(int argc, char** argv) {
  std::vector<LoopRow> rows;
  std::map<std::string, int> refusals;
  bool summary_only = false;
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--time") == 0) {
      measure_time();
      continue;
    }
    if (std::strcmp(argv[k], "--summary") == 0) {
      summary_only = true;
      continue;
    }
    const std::filesystem::path file = argv[k];
    const auto read = app::read_motion({file});
    if (!read) {
      std::fprintf(stderr, "%s\n", read.error().message().c_str());
      ++refusals["the file cannot be read"];
      continue;
    }
    const auto state = edit::make_edit_state(read->motion);
    if (!state) {
      ++refusals[state.error().cause];
      continue;
    }
    auto row = measure_loop(file.stem().string(), *state);
    if (row) {
      rows.push_back(std::move(*row));
      continue;
    }
    ++refusals[cause_of(row.error())];
    std::printf("%s: %s\n", file.stem().c_str(), row.error().message().c_str());
  }
  if (!summary_only && !rows.empty()) print_table(row_table(rows));
  if (!rows.empty() || !refusals.empty()) print_summary(rows, refusals);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc, argv);
}
