// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures courses to goals with captured cycles (engine/models/steer_course.h).
//
//   measure_steer_course ../shared/data/mocap LIBRARY
//
// LIBRARY is the folder of Bandai's first set, for `walk tired`, whose trunk is
// exaggerated by 2: the drunk. Each motion becomes a loop (edit cyclify) and is led to 20
// goals. Prints one row per motion: arrival distances, steps, largest turns, and the
// largest twist and stretch that a standing leg takes.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/clips/make_clip.h"
#include "engine/clips/rig.h"
#include "engine/models/steer_course.h"
#include "engine/models/steer_plan.h"
#include <glm/geometric.hpp>

#include "benchmarks/engine/steered_clips.h"
#include "benchmarks/parts/result_table.h"

namespace marey {
namespace {

namespace fs = std::filesystem;
constexpr double kDegrees = 180.0 / 3.14159265358979323846;
constexpr int kGoals = 20;

struct SteeredClip {
  engine::Rig rig;
  MotionClip clip;
  engine::ClipTravel travel;
};

Result<SteeredClip> make_steered(const fs::path& file, const std::string& name) {
  const auto source = read_cycle(file, name);
  if (!source) return source.error();
  const std::array maps{source->map};
  const auto clip = engine::make_clip(*source, engine::choose_layout(maps));
  if (!clip) return clip.error();
  const auto travel = engine::travel_of_clip(*clip);
  if (!travel) return travel.error();
  return SteeredClip{
      engine::make_rig(source->motion.skeleton, source->map), *clip, *travel};
}

/// True if a foot bears, and the time until that changes. [s]
std::pair<bool, double> bearing(const MotionClip& clip, std::size_t foot, double clip_s) {
  constexpr double kFine_s = 1.0 / 960.0;
  const unsigned bits = 3U << (2 * foot);
  const bool bears = (engine::bearing_at(clip, clip_s) & bits) != 0;
  double until_s = kFine_s;
  while (until_s < clip.duration_s() &&
         ((engine::bearing_at(clip, clip_s + until_s) & bits) != 0) == bears) {
    until_s += kFine_s;
  }
  return {bears, until_s};
}

struct CourseFigures {
  bool arrived = false;
  bool was_reachable = false;
  double distance_m = 0.0, duration_s = 0.0;
  int steps = 0;
  double asked_s = 0.0;
  double turn_rad = 0.0, turn_rad_s = 0.0, twist_rad = 0.0, stretch_m = 0.0;
  double ask_us = 0.0;
};

struct HeldFoot {
  bool bore = false;
  glm::dvec2 place_m{0.0}, stretch_m{0.0};
};

/// The state that the engine would give, and the figures of standing feet.
class CourseWalker {
 public:
  CourseWalker(const SteeredClip& steered, glm::dvec2 goal_m)
      : s_(steered), goal_m_(goal_m), leg_m_(steered.rig.leg_length_m) {}

  CourseFigures run() {
    const engine::SteerQuestion question{{}, 0.0, 1.0, leg_m_, goal_m_};
    // The fastest of three: other programs disturb single measurements.
    figures_.ask_us = 1e9;
    auto answer = engine::ask_steer(s_.clip, s_.travel, question);
    for (int i = 0; i < 3; ++i) {
      const auto start = std::chrono::steady_clock::now();
      answer = engine::ask_steer(s_.clip, s_.travel, question);
      const std::chrono::duration<double, std::micro> asked =
          std::chrono::steady_clock::now() - start;
      figures_.ask_us = std::min(figures_.ask_us, asked.count());
    }
    figures_.was_reachable = answer && answer->reachable;
    figures_.asked_s = answer ? answer->duration_s : 0.0;
    if (!course_.start(s_.clip, s_.travel) || !course_.aim(goal_m_)) return figures_;
    for (int i = 0; i < 4200; ++i) {
      if (step(i)) break;
    }
    return figures_;
  }

 private:
  // Returns whether the course has ended.
  bool step(int i) {
    constexpr double kStep_s = 1.0 / 60.0;
    const double clip_s = i * kStep_s;
    if (i > 0) {
      const double cycle_s = s_.travel.cycle_s;
      const double from_s = std::fmod(clip_s - kStep_s, cycle_s);
      engine::RootPlace by = engine::relative(engine::path_at(s_.clip, from_s),
                                              engine::path_at(s_.clip, from_s + kStep_s));
      root_ = engine::moved(root_, {leg_m_ * by.x_m, leg_m_ * by.z_m, by.heading_rad});
    }
    BlendPosture posture;
    engine::sample_clip(s_.clip, clip_s, posture);
    const engine::FootPlaces feet = engine::foot_places(s_.rig, posture);
    engine::SteerInput in;
    in.time_s = clip_s;
    in.root = root_;
    in.clip_s = clip_s;
    in.leg_length_m = leg_m_;
    for (std::size_t foot = 0; foot < 2; ++foot) {
      std::tie(in.bears[foot], in.until_edge_s[foot]) = bearing(s_.clip, foot, clip_s);
      const glm::dvec2 place =
          glm::dvec2{root_.x_m, root_.z_m} +
          leg_m_ *
              engine::turned({feet.ankle[foot].x, feet.ankle[foot].z}, root_.heading_rad);
      if (in.bears[foot] && !feet_[foot].bore) {
        feet_[foot] = {true, place, {0.0, 0.0}};
        if (i > 0) ++figures_.steps;
        swing_turn_rad_ = 0.0;
      }
      feet_[foot].bore = in.bears[foot];
      in.foot_xz_m[foot] = in.bears[foot] ? feet_[foot].place_m : place;
    }
    return note(course_.step(in), in, kStep_s);
  }

  bool note(const engine::SteerStep& step, const engine::SteerInput& in, double step_s) {
    root_ = engine::steered(root_, step);
    swing_turn_rad_ += step.turn_rad;
    CourseFigures& f = figures_;
    f.turn_rad = std::max(f.turn_rad, std::abs(swing_turn_rad_));
    f.turn_rad_s = std::max(f.turn_rad_s, std::abs(step.turn_rad) / step_s);
    for (std::size_t foot = 0; foot < 2; ++foot) {
      if (!in.bears[foot]) continue;
      f.twist_rad = std::max(f.twist_rad, std::abs(step.twist_rad[foot]));
      glm::dvec2& stretch = feet_[foot].stretch_m;
      stretch = engine::turned(stretch, step.turn_rad) + step.shift_xz_m;
      f.stretch_m = std::max(f.stretch_m, glm::length(stretch));
    }
    f.distance_m = step.distance_m;
    f.duration_s = in.time_s;
    f.arrived = step.arrived;
    return step.state != engine::SteerState::kUnderWay;
  }

  const SteeredClip& s_;
  glm::dvec2 goal_m_;
  double leg_m_;
  engine::SteerCourse course_;
  engine::RootPlace root_;
  std::array<HeldFoot, 2> feet_{};
  double swing_turn_rad_ = 0.0;
  CourseFigures figures_;
};

std::vector<TableCell> row_of(const std::string& name, const SteeredClip& steered) {
  std::vector<double> distances, asks;
  double arrived = 0, wrong = 0, steps = 0, duration = 0;
  CourseFigures worst;
  const double step_m = steered.travel.mean_step_legs * steered.rig.leg_length_m;
  for (int i = 0; i < kGoals; ++i) {
    // Around the start, from 3 to 13 steps away; a clip on the spot up to 1 m.
    const double angle_rad = 2.399963 * i;
    const double far_m =
        steered.travel.travels ? step_m * (3.0 + 0.5 * i) : 0.2 + 0.04 * i;
    const CourseFigures f =
        CourseWalker(steered, {far_m * std::sin(angle_rad), far_m * std::cos(angle_rad)})
            .run();
    arrived += f.arrived && f.distance_m <= 0.2 ? 1 : 0;
    wrong += f.was_reachable != f.arrived || std::abs(f.duration_s - f.asked_s) > 1.0;
    distances.push_back(f.distance_m);
    asks.push_back(f.ask_us);
    steps += f.steps;
    duration += f.duration_s;
    worst.turn_rad = std::max(worst.turn_rad, f.turn_rad);
    worst.turn_rad_s = std::max(worst.turn_rad_s, f.turn_rad_s);
    worst.twist_rad = std::max(worst.twist_rad, f.twist_rad);
    worst.stretch_m = std::max(worst.stretch_m, f.stretch_m);
  }
  std::sort(distances.begin(), distances.end());
  std::sort(asks.begin(), asks.end());
  return {name,
          static_cast<double>(steered.travel.steps.size()),
          steered.travel.cycle_s,
          step_m,
          steered.travel.direction_rad * kDegrees,
          arrived,
          distances[kGoals / 2],
          distances.back(),
          steps / kGoals,
          duration / kGoals,
          wrong,
          worst.turn_rad * kDegrees,
          worst.turn_rad_s * kDegrees,
          worst.twist_rad * kDegrees,
          100.0 * worst.stretch_m,
          asks[kGoals / 2],
          asks.back()};
}

int run(const fs::path& mocap, const fs::path& library) {
  const std::vector<std::pair<std::string, fs::path>> motions{
      {"walk 02_01", mocap / "cmu_asfamc/02_01.amc"},
      {"run 02_03", mocap / "cmu_asfamc/02_03.amc"},
      {"walk bandai", mocap / "bandai/dataset-1_walk_normal_001.bvh"},
      {"dance bandai", mocap / "bandai/dataset-1_dance-short_normal_001.bvh"},
      {"drunk", library / "dataset-1_walk_tired_001.bvh"},
      {"walk left", library / "dataset-1_walk-left_tired_001.bvh"},
      {"walk back", library / "dataset-1_walk-back_old_001.bvh"},
      {"walk giant", library / "dataset-1_walk_giant_001.bvh"},
      {"dash", library / "dataset-1_dash_normal_001.bvh"},
  };
  ResultTable table;
  table.id = "steer";
  table.title = "Courses to 20 goals";
  table.columns = {{"motion"},
                   {"steps", 0},
                   {"cycle s", 2},
                   {"step m", 2},
                   {"direction", 0},
                   {"within 0.2 m", 0},
                   {"median m", 3},
                   {"worst m", 3},
                   {"landings", 1},
                   {"seconds", 1},
                   {"misasked", 0},
                   {"turn deg", 1},
                   {"turn deg/s", 1},
                   {"twist deg", 1},
                   {"stretch cm", 1},
                   {"ask us", 1},
                   {"ask worst us", 1}};
  table.notes = {"misasked: ask_steer() differs in arrival, or its time by more than 1 s",
                 "twist, stretch: taken by hip and knee of a standing leg over a stance"};
  for (const auto& [name, file] : motions) {
    if (!fs::exists(file)) {
      std::printf("%s: no file, left out\n", name.c_str());
      continue;
    }
    const auto steered = make_steered(file, name);
    if (!steered) {
      std::printf("%s: %s\n", name.c_str(), steered.error().message().c_str());
      continue;
    }
    table.rows.push_back(row_of(name, *steered));
  }
  print_table(table);
  return table.rows.empty() ? 1 : 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: measure_steer_course MOCAP LIBRARY\n");
    return 2;
  }
  return marey::run(argv[1], argv[2]);
}
