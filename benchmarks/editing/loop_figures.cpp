// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

#include "benchmarks/editing/loop_figures.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

#include "edit/find/find_loops.h"
#include "edit/ops/close_cycle.h"
#include "edit/ops/seam_acceleration.h"
#include "edit/ops/cyclify.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "core/pose.h"

namespace marey {
namespace {

using Clock = std::chrono::steady_clock;

double loop_milliseconds(Clock::time_point start) {
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

}  // namespace

Result<LoopRow> measure_loop(const std::string& name, const edit::EditState& state) {
  LoopRow row;
  row.name = name;
  auto start = Clock::now();
  (void)edit::find_loops(state);
  row.find_ms = loop_milliseconds(start);
  CyclifyOp op;
  op.cycles = kLoopCycles;
  EditOp common;
  common.parameters = op;
  const edit::EditInputs inputs;
  edit::OpReport report;
  start = Clock::now();
  const auto loop = edit::apply_cyclify(op, {common, 0, inputs}, state, report);
  row.all_ms = loop_milliseconds(start);
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

}  // namespace marey
