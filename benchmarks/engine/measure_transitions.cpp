// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures transitions between captured motions, and loops.
//
//   measure_transitions ../shared/data/mocap [--seed N] [--json FILE] [--switches]
//
// With --switches: a line for each switch of the engine alone, with the worst instants.
//
// Switches at 24 random instants (fixed seed) from walk to run and back (CMU 02_01,
// 02_03, one subject, 120 Hz) and from walk to kick and dance (Bandai Namco, 30 Hz,
// resampled to 120 Hz). All methods play the same switches: those of other engines as
// published (transition_rivals.h), the same synchronised by the supports and with the
// root anchored to the bearing feet, and those of the engine.
//
// The measure has its own forward kinematics, labels and differences; a method reports
// only the times of both clips and their weights. Slide: horizontal speed of ankles and
// toe joints in the 0.3 s after the switch, while the clip that weighs more bears there
// (slower than 50 cm/s, lower than 5 cm above the resting height, in the clip itself).
// Its 95th percentile is over switches. A foot that rolls, lands or leaves moves by this
// label, so the slide of the clips themselves in the same steps stands next to it;
// "still" counts only the points that are slower than 15 cm/s in the clip. Acceleration:
// the largest of a joint or tip within 0.5 s of the switch, over that of both clips.
// Jerk: the mean over joints and tips within 0.5 s of the switch, over that of the clip
// that has more; the column after it is that of the 0.3 s after the switch. Both clips
// and results are compared at the result's rate.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/engine/engine_rival.h"
#include "benchmarks/engine/loop_judge.h"
#include "benchmarks/engine/transition_clips.h"
#include "benchmarks/engine/transition_judge.h"
#include "benchmarks/engine/transition_rivals.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"

namespace marey {
namespace {

constexpr int kSwitches = 24;

/// Figures of the prototype of these methods, with another 24 instants.
const std::vector<std::string> kPrototypeFigures{
    "prototype, slide mean / p95 cm/s; acceleration median / worst:",
    "cut 84 / 453; 18 / 29. crossfade 77 / 183; 0.25 / 0.36.",
    "inertialization 76 / 143; 0.31 / 0.54. dead blending 79 / 187; 0.26 / 0.37.",
    "synchronised: crossfade 80, inertialization 62, dead blending 92.",
    "anchored: crossfade 22 / 54, inertialization 19 / 40, dead blending 21 / 51."};

struct TransitionProgram {
  std::filesystem::path mocap;
  unsigned seed = 1;
  std::filesystem::path json;
  bool prints_switches = false;
};

/// Random instants at which both clips go on long enough.
std::vector<SwitchCase> draw_switches(const TransitionClip& from,
                                      const TransitionClip& to,
                                      unsigned seed) {
  std::mt19937 random(seed);
  constexpr int kAround = static_cast<int>(kPlayedAround_s * kTransitionRate_hz) + 4;
  const auto draw = [&](int first, int end) {
    return (first + static_cast<int>(random() % static_cast<unsigned>(end - first))) /
           kTransitionRate_hz;
  };
  std::vector<SwitchCase> out;
  for (int k = 0; k < kSwitches; ++k) {
    const double leave_s = draw(kAround, from.frame_count() - kAround / 2);
    const double enter_s = draw(6, to.frame_count() - kAround);
    out.push_back({&from, &to, leave_s, enter_s});
  }
  return out;
}

std::vector<TableCell> row_of(std::string method, const MethodFigures& figures) {
  return {std::move(method),
          figures.slide_mean_cm_s,
          figures.slide_p95_cm_s,
          figures.own_slide_mean_cm_s,
          figures.still_slide_mean_cm_s,
          figures.still_slide_p95_cm_s,
          figures.own_still_slide_mean_cm_s,
          figures.acceleration_median,
          figures.acceleration_worst,
          figures.jerk_mean,
          figures.jerk_after_mean,
          figures.settled_median_s,
          figures.hips_beyond_worst_cm,
          figures.leg_extension_worst};
}

void add_rivals(const std::vector<SwitchCase>& cases, ResultTable& table) {
  struct Family {
    const char* name;
    bool is_synchronised = false;
    bool is_anchored = false;
  };
  for (const Family& family : {Family{""},
                               Family{"synchronised ", true},
                               Family{"synchronised, anchored ", true, true}}) {
    for (const RivalMethod method : {RivalMethod::kCut,
                                     RivalMethod::kCrossfade,
                                     RivalMethod::kInertial,
                                     RivalMethod::kDead}) {
      if (method == RivalMethod::kCut && family.is_synchronised) continue;
      std::vector<TransitionResult> results;
      for (const SwitchCase& played : cases) {
        results.push_back(
            play_rival(played, {method, family.is_synchronised, family.is_anchored}));
      }
      table.rows.push_back(
          row_of(family.name + std::string(name(method)), judge_method(cases, results)));
    }
  }
}

ResultTable transition_table(const std::string& id,
                             const TransitionClip& from,
                             const TransitionClip& to,
                             unsigned seed) {
  ResultTable table{id,
                    from.name + " -> " + to.name,
                    {{"method"},
                     {"slide cm/s, mean", 1},
                     {"p95", 1},
                     {"clips' own", 1},
                     {"still cm/s, mean", 1},
                     {"p95", 1},
                     {"clips' own", 1},
                     {"acceleration, median", 2},
                     {"worst", 2},
                     {"jerk", 2},
                     {"0.3 s after", 2},
                     {"90 % after s", 2},
                     {"hips beyond cm", 1},
                     {"leg extension", 4}},
                    {},
                    {}};
  const auto cases = draw_switches(from, to, seed);
  add_rivals(cases, table);
  for (const EngineTransitions& method : engine_transitions(cases)) {
    table.rows.push_back(row_of(method.name, judge_method(cases, method.results)));
  }
  return table;
}

std::string point_name(const Motion& motion, std::size_t point) {
  const auto& joints = motion.skeleton.joints;
  return point < joints.size() ? joints[point].name : "a tip";
}

/// Prints each switch of the engine: its figures, and when and at which point the worst
/// ones are. Times are from the switch. [s]
void print_switches(const TransitionClip& from, const TransitionClip& to, unsigned seed) {
  static constexpr std::array<const char*, kFootPoints> kPoints{
      "left ankle", "right ankle", "left toes", "right toes"};
  const auto cases = draw_switches(from, to, seed);
  const auto method = engine_transitions(cases, "engine: auto, supports").front();
  std::printf("%s -> %s\n", from.name.c_str(), to.name.c_str());
  const auto sources = source_figures(cases.front(), kTransitionRate_hz);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const TransitionResult& result = method.results[k];
    const TransitionFigures one = judge(cases[k], result, sources);
    const auto at = static_cast<std::size_t>(result.switch_s * kTransitionRate_hz + 1.5);
    std::printf(
        "%2zu %s entry %+.2f  slide %5.1f still %5.1f (worst %4.0f at %.2f %s)  "
        "acceleration %.2f at %+.2f %s  hips %.1f cm at %+.2f  leg %.4f\n",
        k,
        result.frames[at].weight[1] >= 1.0 ? "inertial " : "crossfade",
        result.frames[at].source_s[1] - cases[k].enter_s,
        one.slide_cm_s,
        one.still_slide_cm_s,
        one.worst_slide_cm_s,
        one.worst_slide_at_s,
        kPoints[one.worst_slide_point],
        one.acceleration,
        one.acceleration_at_s,
        point_name(result.motion, one.acceleration_point).c_str(),
        one.hips_beyond_cm,
        one.hips_beyond_at_s,
        one.leg_extension);
  }
  const MethodFigures all = judge_method(cases, method.results);
  std::printf(
      "all: slide %.1f p95 %.1f own %.1f, still %.1f p95 %.1f own %.1f, "
      "acceleration %.2f %.2f, jerk %.2f, 90%% %.2f s, hips %.1f, leg %.4f\n",
      all.slide_mean_cm_s,
      all.slide_p95_cm_s,
      all.own_slide_mean_cm_s,
      all.still_slide_mean_cm_s,
      all.still_slide_p95_cm_s,
      all.own_still_slide_mean_cm_s,
      all.acceleration_median,
      all.acceleration_worst,
      all.jerk_mean,
      all.settled_median_s,
      all.hips_beyond_worst_cm,
      all.leg_extension_worst);
}

double mean_slide(const std::vector<double>& slides_cm_s) {
  double sum_cm_s = 0.0;
  for (const double slide_cm_s : slides_cm_s) sum_cm_s += slide_cm_s;
  return slides_cm_s.empty() ? 0.0 : sum_cm_s / static_cast<double>(slides_cm_s.size());
}

ResultTable clip_table(const TransitionClips& clips) {
  ResultTable table{"clips",
                    "The clips themselves",
                    {{"clip"},
                     {"slide cm/s, mean", 1},
                     {"p95 of steps", 1},
                     {"still, mean", 1},
                     {"greatest acceleration m/s^2", 0},
                     {"at 60 Hz", 0},
                     {"mean jerk m/s^3", 0},
                     {"at 60 Hz", 0}},
                    {},
                    {}};
  for (const TransitionClip* clip : {&clips.walk,
                                     &clips.run,
                                     &clips.bandai_walk,
                                     &clips.bandai_kick,
                                     &clips.bandai_dance}) {
    const SlideSamples slides = own_slides(*clip);
    const SourceFigures full = source_figures(*clip, kTransitionRate_hz);
    const SourceFigures half = source_figures(*clip, 0.5 * kTransitionRate_hz);
    table.rows.push_back({clip->name,
                          mean_slide(slides.points),
                          quantile(slides.points, 0.95),
                          mean_slide(slides.still),
                          full.peak_acceleration_m_s2,
                          half.peak_acceleration_m_s2,
                          full.mean_jerk_m_s3,
                          half.mean_jerk_m_s3});
  }
  return table;
}

void add_loops(const TransitionClip& clip, ResultTable& table) {
  const auto loop = make_loop_clip(clip);
  if (!loop) {
    table.notes.push_back(clip.name + ": " + loop.error().message());
    return;
  }
  std::vector<EngineLoop> players{{"whole cycles, double", exact_loop_player(*loop)},
                                  {"float steps added", float_loop_player(*loop)}};
  for (EngineLoop& player : engine_loops(*loop)) players.push_back(std::move(player));
  for (const EngineLoop& player : players) {
    const LoopFigures figures = judge_loop(*loop, player.player);
    table.rows.push_back({clip.name + ", " + player.name,
                          static_cast<double>(figures.cycles),
                          static_cast<double>(loop->cycle_frames()),
                          figures.path_error_mm,
                          figures.heading_error_deg,
                          figures.bone_error_mm,
                          figures.posture_error_mm,
                          figures.seam_m_s2,
                          figures.inner_m_s2});
  }
}

ResultTable loop_table(const TransitionClips& clips) {
  ResultTable table{"loops",
                    "Loops (cyclified)",
                    {{"loop, player"},
                     {"cycles", 0},
                     {"frames each", 0},
                     {"path error mm", 4},
                     {"heading error deg", 5},
                     {"joints of bones mm", 4},
                     {"all joints, tips mm", 4},
                     {"seam m/s^2", 1},
                     {"inner m/s^2", 1}},
                    {},
                    {}};
  add_loops(clips.walk, table);
  add_loops(clips.run, table);
  return table;
}

int run(const TransitionProgram& program) {
  const auto clips = read_transition_clips(program.mocap);
  if (!clips) {
    std::fprintf(stderr, "%s\n", clips.error().message().c_str());
    return 1;
  }
  if (program.prints_switches) {
    print_switches(clips->walk, clips->run, program.seed);
    print_switches(clips->run, clips->walk, program.seed);
    print_switches(clips->bandai_walk, clips->bandai_kick, program.seed);
    print_switches(clips->bandai_walk, clips->bandai_dance, program.seed);
    return 0;
  }
  std::vector<ResultTable> tables;
  const auto add = [&](ResultTable table) {
    print_table(table);
    tables.push_back(std::move(table));
  };
  add(clip_table(*clips));
  ResultTable walk_run =
      transition_table("walk_run", clips->walk, clips->run, program.seed);
  walk_run.notes = kPrototypeFigures;
  add(std::move(walk_run));
  add(transition_table("run_walk", clips->run, clips->walk, program.seed));
  add(transition_table(
      "walk_kick", clips->bandai_walk, clips->bandai_kick, program.seed));
  add(transition_table(
      "walk_dance", clips->bandai_walk, clips->bandai_dance, program.seed));
  add(loop_table(*clips));
  if (program.json.empty()) return 0;
  const auto written = write_tables(program.json, tables);
  if (written) return 0;
  std::fprintf(stderr, "%s\n", written.error().message().c_str());
  return 1;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  marey::TransitionProgram program;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--seed" && k + 1 < argc) {
      program.seed = static_cast<unsigned>(std::strtoul(argv[++k], nullptr, 10));
    } else if (word == "--json" && k + 1 < argc) {
      program.json = argv[++k];
    } else if (word == "--switches") {
      program.prints_switches = true;
    } else {
      program.mocap = word;
    }
  }
  if (program.mocap.empty()) {
    std::fprintf(stderr,
                 "usage: measure_transitions MOCAP_FOLDER [--seed N] [--json FILE] "
                 "[--switches]\n");
    return 2;
  }
  return marey::run(program);
}
