// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions whose zero moment point was moved into the support area, on the captured body
// and on five others, judged by independent code. Usage:
//   measure_keep_zmp [--bodies] DATA_FOLDER [MOTION...]
// DATA_FOLDER is ../shared/data, whose walk with force plates is measured first. With
// --bodies each motion is also retargeted to five bodies. The last rows are sums.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "edit/balance/shift_zmp.h"
#include "edit/balance/zmp_track.h"
#include "edit/state/edit_state.h"

#include "benchmarks/dynamics/jump_clips.h"
#include "benchmarks/retarget/scaled_bodies.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/truth/zmp_judge.h"

namespace marey {
namespace {

constexpr std::array kZmpBodies{BodyScale{"0.6 m", 0.34, 0.34, 0.34},
                                BodyScale{"child", 0.7, 0.72, 0.7},
                                BodyScale{"long legs", 1.15, 0.95, 1.0},
                                BodyScale{"long trunk", 0.9, 1.1, 1.0},
                                BodyScale{"2.5 m", 1.42, 1.42, 1.42}};
constexpr double kLoadedJudge_g = 0.2;
/// Distances up to this are rounding.
constexpr double kInside_m = 1e-6;

/// Frames of one motion, as the independent judge counts them.
struct JudgedFrames {
  int loaded = 0;
  int supported = 0;
  int outside = 0;
  int far_outside = 0;  ///< By more than 10 mm.
  double worst_mm = 0.0;
  int worst_frame = -1;
};

JudgedFrames judged(const edit::EditState& state,
                    const std::vector<PointMass>& masses,
                    const edit::ZmpGround& ground,
                    const Motion& motion) {
  JudgedFrames out;
  const auto frames = testing::judge_zmp(motion,
                                         testing::judged_feet(state.map),
                                         masses,
                                         ground.loaded,
                                         ground.floor_height_m);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    if (frames[t].vertical_force_g < kLoadedJudge_g) continue;
    ++out.loaded;
    if (!frames[t].outside_m) continue;
    ++out.supported;
    if (*frames[t].outside_m <= kInside_m) continue;
    ++out.outside;
    if (*frames[t].outside_m > 0.01) ++out.far_outside;
    if (1e3 * *frames[t].outside_m > out.worst_mm) {
      out.worst_mm = 1e3 * *frames[t].outside_m;
      out.worst_frame = static_cast<int>(t);
    }
  }
  return out;
}

struct ZmpTotals {
  int motions = 0;
  int whole = 0;  ///< Motions without a frame outside.
  JudgedFrames before;
  JudgedFrames after;
  std::vector<double> shifts_mm;

  void add(const JudgedFrames& was, const JudgedFrames& is, double shift_mm) {
    ++motions;
    if (is.outside == 0) ++whole;
    const auto sum = [](JudgedFrames& to, const JudgedFrames& one) {
      to.loaded += one.loaded;
      to.supported += one.supported;
      to.outside += one.outside;
      to.far_outside += one.far_outside;
      to.worst_mm = std::max(to.worst_mm, one.worst_mm);
    };
    sum(before, was);
    sum(after, is);
    shifts_mm.push_back(shift_mm);
  }
};

double jerk_of(const Motion& motion) {
  double sum = 0.0;
  for (std::size_t t = 3; t < motion.poses.size(); ++t) {
    const auto root = [&](std::size_t i) { return motion.poses[t - i].root_in_world; };
    sum += glm::length(root(0) - 3.0 * root(1) + 3.0 * root(2) - root(3));
  }
  return sum;
}

void measure_motion(const std::string& name, Motion motion, ZmpTotals& totals) {
  const auto state = edit::make_edit_state(std::move(motion));
  if (!state) {
    std::printf("%-44s %s\n", name.c_str(), state.error().message().c_str());
    return;
  }
  const auto masses = retarget::place_masses(state->motion.skeleton, state->map, {});
  if (!masses || state->motion.poses.size() < 8) return;
  const edit::ZmpGround ground =
      edit::zmp_ground(state->motion, state->map, state->contacts);
  edit::OpWeights weights;
  weights.weight.assign(state->motion.poses.size(), 1.0);
  weights.frames = {0, state->frame_count() - 1};
  Motion moved = state->motion;
  const auto start = std::chrono::steady_clock::now();
  const auto report = edit::shift_zmp(*state, *masses, weights, moved);
  const double cost_us =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
          .count() /
      static_cast<double>(moved.poses.size());
  const JudgedFrames was = judged(*state, *masses, ground, state->motion);
  const JudgedFrames is = judged(*state, *masses, ground, moved);
  totals.add(was, is, 1e3 * report.max_shift_m);
  std::printf(
      "%-44s %5zu %5d %5d | %5d %7.0f | %4d %4d %6.1f %5d | %4.0f %4.0f %5.1f %5.2f "
      "%6.0f\n",
      name.c_str(),
      moved.poses.size(),
      is.loaded,
      is.supported,
      was.outside,
      was.worst_mm,
      is.outside,
      is.far_outside,
      is.worst_mm,
      is.worst_frame,
      1e3 * report.max_shift_m,
      1e3 * report.lowered_m,
      1e3 * report.missed_m,
      jerk_of(moved) / std::max(1e-12, jerk_of(state->motion)),
      cost_us);
  std::fflush(stdout);
}

void measure_bodies(const std::string& name,
                    const Motion& motion,
                    bool has_bodies,
                    std::array<ZmpTotals, 2>& totals) {
  measure_motion(name, motion, totals[0]);
  if (!has_bodies) return;
  for (const BodyScale& body : kZmpBodies) {
    const auto made = retarget::retarget_motion(motion, scaled(motion.skeleton, body));
    if (made) measure_motion(name + ", " + body.name, made->motion, totals[1]);
  }
}

void print_totals(const char* name, ZmpTotals& totals) {
  if (totals.motions == 0) return;
  std::sort(totals.shifts_mm.begin(), totals.shifts_mm.end());
  std::printf(
      "%s: %d motions, %d without a frame outside; %d supported frames, outside %d (%.2f "
      "%%) before, %d (%.3f %%) after, %d by more than 10 mm, worst %.0f mm; median "
      "shift "
      "%.0f mm\n",
      name,
      totals.motions,
      totals.whole,
      totals.after.supported,
      totals.before.outside,
      100.0 * totals.before.outside / std::max(1, totals.before.supported),
      totals.after.outside,
      100.0 * totals.after.outside / std::max(1, totals.after.supported),
      totals.after.far_outside,
      totals.after.worst_mm,
      totals.shifts_mm[totals.shifts_mm.size() / 2]);
}

int run(int argc, char** argv) {
  const bool has_bodies = argc > 1 && std::strcmp(argv[1], "--bodies") == 0;
  const int first = has_bodies ? 2 : 1;
  const std::filesystem::path data = argc > first ? argv[first] : "../shared/data";
  std::printf(
      "%-44s %5s %5s %5s | %13s | %23s | %4s %4s %5s %5s %6s\n"
      "%-44s %17s | %5s %7s | %4s %4s %6s %5s | %s\n",
      "motion",
      "frames",
      "load",
      "supp",
      "before",
      "after",
      "move",
      "low",
      "foot",
      "jerk",
      "us",
      "",
      "",
      "out",
      "worst",
      "out",
      ">10",
      "worst",
      "frame",
      "mm, mm, mm, ratio, per frame");
  std::array<ZmpTotals, 2> totals;
  for (const ContactSource& source : contact_sources()) {
    if (source.name != "Rajagopal walk") continue;
    const auto trial = read_contact_trial(data / "mocap", source);
    if (trial) measure_bodies(source.name, trial->motion, has_bodies, totals);
  }
  for (int i = first + 1; i < argc; ++i) {
    const std::filesystem::path file = argv[i];
    const auto clip = read_jump_clip(file, "clip");
    if (!clip) {
      std::printf("%s: %s\n", file.stem().c_str(), clip.error().message().c_str());
      continue;
    }
    measure_bodies(file.stem().string(), clip->motion, has_bodies, totals);
  }
  print_totals("captured body", totals[0]);
  print_totals("five bodies", totals[1]);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc, argv);
}
