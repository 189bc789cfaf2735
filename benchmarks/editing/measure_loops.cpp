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
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edit/find/find_loops.h"
#include "edit/ops/close_cycle.h"
#include "edit/ops/cyclify.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "app/motion/retarget_files.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey {
namespace {

constexpr int kCycles = 10;
constexpr double kMaxSlide_cm_per_s = 0.3;
constexpr double kMaxPeriodError = 0.05;

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

using Places = std::vector<std::vector<glm::dvec3>>;  // [frame][bone].

// Joints of a cycle with `margin` frames before and after it.
Places cyclic_places(const Motion& cycle, const edit::PlanarMove& step, int margin) {
  Places out;
  const int frames = static_cast<int>(cycle.poses.size());
  for (int n = -margin; n < frames + margin; ++n) {
    const int copy = n < 0 ? -1 : n / frames;
    const edit::PlanarMove move = edit::power(step, copy);
    const Pose& pose = cycle.poses[static_cast<std::size_t>(n - copy * frames)];
    out.emplace_back();
    const std::vector<RigidTransform> world = world_from_joints(cycle.skeleton, pose);
    for (std::size_t j = 0; j < world.size(); ++j) {
      if (cycle.skeleton.joints[j].bone) out.back().push_back(move(world[j].translation));
    }
  }
  return out;
}

// Largest difference, over joints, of the velocities at a frame by cubics through the
// four frames that end there and through the four that begin there. [m/s]
double velocity_jump(const Places& places, std::size_t t, double hz) {
  constexpr std::array<double, 4> kSlope{-11.0 / 6.0, 3.0, -1.5, 1.0 / 3.0};
  double largest = 0.0;
  for (std::size_t j = 0; j < places[t].size(); ++j) {
    glm::dvec3 jump(0.0);
    for (std::size_t k = 0; k < kSlope.size(); ++k) {
      jump += kSlope[k] * (places[t + k][j] + places[t - k][j]);
    }
    largest = std::max(largest, glm::length(jump) * hz);
  }
  return largest;
}

struct SeamVelocity {
  double seam = 0.0;
  double inside = 0.0;  // 95th percentile.
};
SeamVelocity seam_velocity(const Motion& cycle, const edit::PlanarMove& step) {
  const Places places = cyclic_places(cycle, step, 3);
  SeamVelocity out;
  std::vector<double> inside;
  for (std::size_t t = 3; t + 3 < places.size(); ++t) {
    const double jump = velocity_jump(places, t, cycle.rate.hz);
    if (t == 3) {
      out.seam = jump;
    } else {
      inside.push_back(jump);
    }
  }
  out.inside = quantile(inside, 0.95);
  return out;
}

// Mean time between two strikes of one foot around the middle of the loop. [s]
std::optional<double> strike_period_s(const edit::EditState& state, double middle) {
  double sum = 0.0;
  int count = 0;
  for (const auto& foot : state.contacts.feet) {
    std::optional<double> nearest;
    double off = 0.0;
    for (std::size_t k = 1; k < foot.stance.size(); ++k) {
      const int from = foot.stance[k - 1].first;
      const int to = foot.stance[k].first;
      const double away = std::abs(0.5 * (from + to) - middle);
      if (from == 0 || (nearest && away >= off)) continue;
      nearest = (to - from) / state.motion.rate.hz;
      off = away;
    }
    if (!nearest) continue;
    sum += *nearest;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

// All joints alike, without the velocities.
edit::MatchPoints plain_points(const edit::EditState& state) {
  edit::MatchPoints points = edit::match_points(state.motion, state.map);
  for (double& weight : points.weights) weight = 1.0 / points.point_count();
  return points;
}

// Median over pairs of frames, some thousands, more than a tenth of a second apart.
double median_gap_m(const edit::MatchPoints& points, double hz) {
  const int step = std::max(1, points.frame_count() / 80);
  const int apart = static_cast<int>(std::ceil(0.1 * hz));
  std::vector<double> gaps;
  for (int i = 0; i < points.frame_count(); i += step) {
    for (int j = i + apart; j < points.frame_count(); j += step) {
      gaps.push_back(edit::match_windows(points, j, points, i).rms_m);
    }
  }
  return gaps.empty() ? 0.0 : quantile(gaps, 0.5);
}

struct LoopRow {
  std::string name;
  double period_s = 0.0;
  std::optional<double> strikes_s;
  double change_percent = 0.0;
  double gap_mm = 0.0, plain_mm = 0.0, worst_mm = 0.0, median_mm = 0.0;
  double velocity_gap = 0.0, plain_velocity_gap = 0.0;
  double turn_deg = 0.0, travel_m = 0.0;
  double cut_acceleration = 0.0, cut_inside = 0.0;
  double seam_acceleration = 0.0, inside_acceleration = 0.0;
  double seam_jump = 0.0, inside_jump = 0.0;
  double slide_source = 0.0, slide_loop = 0.0, drift_m = 0.0, displaced_mm = 0.0;
  double find_ms = 0.0, all_ms = 0.0;
};

double figure(const edit::OpReport& report, const std::string& name) {
  for (const auto& [key, value] : report.figures) {
    if (key == name) return value;
  }
  return 0.0;
}

// The cycle as it is cut, repeated without any correction.
void measure_cut(const edit::EditState& state, double first, int frames, LoopRow& row) {
  const int start = static_cast<int>(first);
  const int end = std::min(start + frames, state.frame_count() - 1);
  const edit::MatchPoints plain = plain_points(state);
  const edit::PlanarMatch match = edit::match_windows(plain, end, plain, start);
  const edit::LoopCandidate loop = edit::compare_loop(state, start, end);
  const edit::EditState cut = edit::slice_state(state, {start, end - 1});
  const auto seam = edit::seam_acceleration(cut.motion, loop.match.a_from_b);
  row.cut_acceleration = seam.seam;
  row.cut_inside = seam.inside;
  row.plain_mm = 1e3 * match.rms_m;
  row.plain_velocity_gap = match.rms_velocity_m_per_s;
  row.median_mm = 1e3 * median_gap_m(plain, state.motion.rate.hz);
  row.strikes_s = strike_period_s(state, start + 0.5 * frames);
}

// Largest distance of a copy's first frame from the first one moved by whole travels. [m]
double drift_m(const edit::EditState& loop, int frames, const edit::PlanarMove& step) {
  double largest = 0.0;
  for (int copy = 1; copy * frames < loop.frame_count(); ++copy) {
    const auto t = static_cast<std::size_t>(copy * frames);
    const glm::dvec3 truth =
        edit::power(step, copy)(loop.motion.poses.front().root_in_world);
    largest = std::max(largest, glm::distance(truth, loop.motion.poses[t].root_in_world));
  }
  return largest;
}

Result<LoopRow> measure(const std::string& name, const edit::EditState& state) {
  LoopRow row;
  row.name = name;
  auto start = Clock::now();
  (void)edit::find_loops(state);
  row.find_ms = milliseconds_since(start);
  CyclifyOp op;
  op.cycles = kCycles;
  EditOp common;
  common.parameters = op;
  const edit::EditInputs inputs;
  edit::OpReport report;
  start = Clock::now();
  const auto loop = edit::apply_cyclify(op, {common, 0, inputs}, state, report);
  row.all_ms = milliseconds_since(start);
  if (!loop) return loop.error();
  const int frames = static_cast<int>(figure(report, "frames"));
  const edit::EditState cycle = edit::slice_state(*loop, {0, frames - 1});
  edit::PlanarMove step;
  const edit::MatchPoints points = edit::match_points(loop->motion, loop->map);
  step = edit::match_windows(points, frames, points, 0, {.half_window = 0}).a_from_b;
  const edit::SeamAcceleration seam = edit::seam_acceleration(cycle.motion, step);
  const SeamVelocity jump = seam_velocity(cycle.motion, step);
  row.period_s = figure(report, "period_s");
  row.change_percent = figure(report, "period_change_percent");
  row.gap_mm = figure(report, "gap_rms_mm");
  row.worst_mm = figure(report, "gap_worst_mm");
  row.velocity_gap = figure(report, "velocity_gap_m_per_s");
  row.turn_deg = figure(report, "turn_deg");
  row.travel_m = figure(report, "travel_m");
  row.displaced_mm = figure(report, "displaced_mm");
  measure_cut(state, figure(report, "first_frame"), frames, row);
  row.seam_acceleration = seam.seam;
  row.inside_acceleration = seam.inside;
  row.seam_jump = jump.seam;
  row.inside_jump = jump.inside;
  row.slide_source = edit::measure_slide(state).mean_cm_per_s;
  row.slide_loop = edit::measure_slide(*loop).mean_cm_per_s;
  row.drift_m = drift_m(*loop, frames, step);
  return row;
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
      "period s: of the loop; strikes s: mean of both feet's time between strikes, "
      "around "
      "the middle of the loop",
      "gap, worst: joints at the ends of the cycle, weighted rms and largest, before "
      "correction; dv: rms of velocities; plain: all joints alike; median: the same, of "
      "all "
      "pairs of frames",
      "a: largest acceleration of a joint in m/s^2 at the seam, as cut and after; p95: "
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
    auto row = measure(file.stem().string(), *state);
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
