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

#include "dynamics/balance/preview_control.h"
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
constexpr double kNear_s = 0.06;
/// Largest wanted displacement of a point in a stream.
constexpr double kMaxStream_m = 0.3;
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
  // Causes of frames outside, each frame by the first that applies.
  int near_end = 0;       ///< Within 60 ms of an end of the clip.
  int near_unloaded = 0;  ///< Within 60 ms of a frame without load or without support.
  int light = 0;          ///< The force is below half of the weight.
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
    const auto near = static_cast<std::size_t>(std::lround(kNear_s * motion.rate.hz));
    const std::size_t from = t < near ? 0 : t - near;
    const std::size_t to = std::min(t + near, frames.size() - 1);
    bool is_near_unloaded = false;
    for (std::size_t k = from; k <= to; ++k) {
      is_near_unloaded |=
          frames[k].vertical_force_g < kLoadedJudge_g || !frames[k].outside_m;
    }
    if (t < near || t + near >= frames.size()) {
      ++out.near_end;
    } else if (is_near_unloaded) {
      ++out.near_unloaded;
    } else if (frames[t].vertical_force_g < 0.5) {
      ++out.light;
    }
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
  int streamed_supported = 0;  ///< Frames of streams behind the delay.
  int streamed_outside = 0;
  int streamed_before = 0;

  void add(const JudgedFrames& was, const JudgedFrames& is, double shift_mm) {
    ++motions;
    if (is.outside == 0) ++whole;
    const auto sum = [](JudgedFrames& to, const JudgedFrames& one) {
      to.loaded += one.loaded;
      to.supported += one.supported;
      to.outside += one.outside;
      to.far_outside += one.far_outside;
      to.near_end += one.near_end;
      to.near_unloaded += one.near_unloaded;
      to.light += one.light;
      to.worst_mm = std::max(to.worst_mm, one.worst_mm);
    };
    sum(before, was);
    sum(after, is);
    shifts_mm.push_back(shift_mm);
  }
};

/// Streams a motion through the preview control: only the centre of mass is displaced.
/// Counts the frames that are outside.
void measure_stream(const edit::EditState& state,
                    const std::vector<PointMass>& masses,
                    const edit::ZmpGround& ground,
                    ZmpTotals& totals) {
  const edit::ZmpTrack track = edit::zmp_track(state.motion, state.map, masses, ground);
  const std::size_t frames = track.com_in_world.size();
  double height_m = 0.0;
  for (const glm::dvec3& com : track.com_in_world) {
    height_m += (com.y - ground.floor_height_m) / static_cast<double>(frames);
  }
  if (height_m <= 0.0) return;
  dynamics::PreviewBalance balance(state.motion.rate, height_m);
  const std::size_t delay = balance.latency_frames();
  std::vector<glm::dvec3> moved = track.com_in_world;
  for (std::size_t t = 0; t < frames; ++t) {
    glm::dvec2 wanted(0.0);
    if (const auto& zmp = track.reactions[t].zmp_xz_m) {
      wanted = dynamics::moved_inside(track.supports[t], *zmp, 0.01) - *zmp;
      const double way_m = glm::length(wanted);
      if (way_m > kMaxStream_m) wanted *= kMaxStream_m / way_m;
    }
    const glm::dvec2 shift = balance.step(wanted);
    if (t >= delay) moved[t - delay] += glm::dvec3(shift.x, 0.0, shift.y);
  }
  if (frames <= 2 * delay) return;
  dynamics::ZmpOptions options;
  options.floor_height_m = ground.floor_height_m;
  const auto before =
      dynamics::ground_reactions(track.com_in_world, {}, state.motion.rate, options);
  const auto after = dynamics::ground_reactions(moved, {}, state.motion.rate, options);
  for (std::size_t t = delay; t + delay < frames; ++t) {
    if (!track.reactions[t].zmp_xz_m || !after[t].zmp_xz_m) continue;
    const glm::dvec2 p =
        *track.reactions[t].zmp_xz_m + *after[t].zmp_xz_m - *before[t].zmp_xz_m;
    const auto outside_m = dynamics::distance_outside(track.supports[t], p);
    if (!outside_m) continue;
    ++totals.streamed_supported;
    if (*outside_m > 0.0) ++totals.streamed_outside;
    totals.streamed_before +=
        *dynamics::distance_outside(track.supports[t], *track.reactions[t].zmp_xz_m) > 0.0
            ? 1
            : 0;
  }
}

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
  measure_stream(*state, *masses, ground, totals);
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
  std::printf(
      "  outside after: %d near the ends of clips, %d near frames without load or "
      "support, "
      "%d with less than half of the weight, %d others\n"
      "  streams with a delay of 0.8 s, centre of mass alone: outside %d of %d before, "
      "%d "
      "after\n",
      totals.after.near_end,
      totals.after.near_unloaded,
      totals.after.light,
      totals.after.outside - totals.after.near_end - totals.after.near_unloaded -
          totals.after.light,
      totals.streamed_before,
      totals.streamed_supported,
      totals.streamed_outside);
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
