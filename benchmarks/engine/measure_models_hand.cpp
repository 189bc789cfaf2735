// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Accuracy of the models of a hand: 200 reaches with a captured hand to still and moving
// targets, and throws of seven parameters times nine values, judged by the places of the
// hand alone. Rivals: the displacement faded in with the weight of an IK solver, and one
// plan that is not recomputed. Usage:
//   measure_models_hand [SHARED_DATA]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "engine/models/reach_course.h"
#include "engine/models/throw_course.h"
#include <glm/geometric.hpp>

#include "benchmarks/engine/captured_hand.h"
#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/smooth_step.h"
#include "core/base/stopwatch.h"
#include "tests/support/truth/truth_motion.h"

namespace marey {
namespace {

constexpr double kStep_s = 1.0 / 60.0;

[[noreturn]] void fail(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

double quantile_of(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Places at steady times; velocity and acceleration by their differences.
struct SampledWay {
  double step_s = 0.0;
  std::vector<glm::dvec3> places;

  // On the polynomial through `count` samples that end at or before the time.
  [[nodiscard]] glm::dvec3 place(double time_s, double last_s, int count = 6) const {
    const int last = static_cast<int>(std::floor(last_s / step_s + 1e-6));
    glm::dvec3 sum(0.0);
    for (int i = last - count + 1; i <= last; ++i) {
      double weight = 1.0;
      for (int j = last - count + 1; j <= last; ++j) {
        if (j != i) weight *= (time_s / step_s - j) / (i - j);
      }
      sum += weight * places[static_cast<std::size_t>(i)];
    }
    return sum;
  }
  [[nodiscard]] glm::dvec3 velocity(double time_s) const {
    constexpr double kE_s = 1e-4;
    return (place(time_s + kE_s, time_s) - place(time_s - kE_s, time_s)) / (2.0 * kE_s);
  }
  [[nodiscard]] double max_acceleration() const {
    double max = 0.0;
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
      max = std::max(max,
                     glm::length(places[i + 1] - 2.0 * places[i] + places[i - 1]) /
                         (step_s * step_s));
    }
    return max;
  }
};

struct ReachTrial {
  double start_s = 0.0;  // In the clip.
  double length_s = 0.0;
  engine::ReachTarget target;  // At the start.
  glm::dvec3 direction{0.0};
  double speed_m_s = 0.0;
  [[nodiscard]] engine::ReachTarget target_at(double since_s) const {
    engine::ReachTarget moved = target;
    moved.p_in_world += since_s * target.velocity_m_s;
    return moved;
  }
};

glm::dvec3 any_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

ReachTrial make_trial(std::mt19937& random, const CapturedHand& hand, bool moves) {
  const auto between = [&](double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random);
  };
  ReachTrial trial;
  trial.length_s = between(0.5, 1.1);
  trial.start_s = between(0.1, hand.duration_s() - trial.length_s - 0.3);
  trial.direction = any_direction(random);
  trial.speed_m_s = between(0.05, 0.5);
  if (moves) trial.target.velocity_m_s = between(0.0, 0.5) * any_direction(random);
  trial.target.p_in_world = hand.at(trial.start_s + trial.length_s).p_in_world -
                            trial.length_s * trial.target.velocity_m_s +
                            between(0.05, 0.35) * any_direction(random);
  trial.target.approach = trial.direction;
  trial.target.speed_m_s = trial.speed_m_s;
  return trial;
}

using Method =
    std::function<SampledWay(const CapturedHand&, const ReachTrial&, double step_s)>;

// Until a step after the arrival.
SampledWay play_marey(const CapturedHand& hand, const ReachTrial& trial, double step_s) {
  engine::ReachCourse course;
  course.start(0.0, hand.at(trial.start_s), {});
  SampledWay way{step_s, {hand.at(trial.start_s).p_in_world}};
  const engine::HandMotion arrival = hand.at(trial.start_s + trial.length_s);
  for (int i = 1; (i - 1) * step_s <= trial.length_s; ++i) {
    engine::ReachInput input;
    input.time_s = i * step_s;
    input.step_s = step_s;
    input.clip_now = hand.at(trial.start_s + input.time_s);
    input.clip_at_arrival = arrival;
    input.arrive_s = trial.length_s;
    input.target = trial.target_at(input.time_s);
    way.places.push_back(course.step(input).hand.p_in_world);
  }
  return way;
}

// Weight of an IK target: the hand goes from the clip to the target.
SampledWay play_weight(const CapturedHand& hand, const ReachTrial& trial, double step_s) {
  SampledWay way{step_s, {}};
  for (int i = 0; (i - 1) * step_s <= trial.length_s; ++i) {
    const glm::dvec3 clip = hand.at(trial.start_s + i * step_s).p_in_world;
    const glm::dvec3 target = trial.target_at(i * step_s).p_in_world;
    way.places.push_back(clip +
                         smooth_step(i * step_s / trial.length_s) * (target - clip));
  }
  return way;
}

// The plan of the first step, to where the target is then.
SampledWay play_once(const CapturedHand& hand, const ReachTrial& trial, double step_s) {
  const engine::HandMotion arrival = hand.at(trial.start_s + trial.length_s);
  const engine::QuinticLeg leg =
      engine::quintic_leg(0.0,
                          trial.length_s,
                          {},
                          {trial.target.p_in_world - arrival.p_in_world,
                           trial.speed_m_s * trial.direction + trial.target.velocity_m_s -
                               arrival.velocity_m_s,
                           -arrival.acceleration_m_s2});
  SampledWay way{step_s, {}};
  for (int i = 0; (i - 1) * step_s <= trial.length_s; ++i) {
    way.places.push_back(hand.at(trial.start_s + i * step_s).p_in_world +
                         leg.at(i * step_s).value);
  }
  return way;
}

std::vector<TableCell> reach_row(const std::string& name,
                                 const CapturedHand& hand,
                                 const std::vector<ReachTrial>& trials,
                                 const Method& play) {
  std::vector<double> place_mm, speed, angle_deg, acceleration, more;
  for (const ReachTrial& trial : trials) {
    const double end_s = trial.length_s;
    const SampledWay way = play(hand, trial, kStep_s);
    const SampledWay fine = play(hand, trial, kStep_s / 32);
    place_mm.push_back(1e3 * glm::distance(way.place(end_s, end_s + kStep_s),
                                           trial.target_at(end_s).p_in_world));
    const glm::dvec3 velocity = fine.velocity(end_s) - trial.target.velocity_m_s;
    speed.push_back(100.0 * std::abs(glm::length(velocity) - trial.speed_m_s) /
                    trial.speed_m_s);
    const double cosine = glm::dot(glm::normalize(velocity), trial.direction);
    angle_deg.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 57.29578);
    SampledWay clip{kStep_s, {}};
    for (std::size_t i = 0; i < way.places.size(); ++i) {
      clip.places.push_back(
          hand.at(trial.start_s + static_cast<double>(i) * kStep_s).p_in_world);
    }
    acceleration.push_back(way.max_acceleration());
    more.push_back(way.max_acceleration() - clip.max_acceleration());
  }
  return {name,
          quantile_of(place_mm, 0.5),
          quantile_of(place_mm, 1.0),
          quantile_of(speed, 0.5),
          quantile_of(speed, 1.0),
          quantile_of(angle_deg, 1.0),
          quantile_of(acceleration, 0.5),
          quantile_of(acceleration, 1.0),
          quantile_of(more, 0.5),
          quantile_of(more, 1.0)};
}

void measure_reaches(const CapturedHand& hand) {
  ResultTable table{"reach",
                    "200 reaches of a captured hand, 0.5 to 1.1 s, 60 Hz",
                    {{"method", 0},
                     {"place mm", 2},
                     {"worst", 2},
                     {"speed %", 2},
                     {"worst", 2},
                     {"worst deg", 2},
                     {"m/s^2", 1},
                     {"worst", 1},
                     {"over clip", 1},
                     {"worst", 1}},
                    {},
                    {}};
  const std::vector<std::pair<std::string, Method>> methods{
      {"marey", play_marey}, {"IK weight", play_weight}, {"one plan", play_once}};
  for (const bool moves : {false, true}) {
    std::mt19937 random(1);
    std::vector<ReachTrial> trials;
    for (int i = 0; i < 100; ++i) trials.push_back(make_trial(random, hand, moves));
    for (const auto& [name, play] : methods) {
      table.rows.push_back(
          reach_row(name + (moves ? ", moving" : ", still"), hand, trials, play));
    }
  }
  std::mt19937 random(2);
  const ReachTrial trial = make_trial(random, hand, true);
  engine::ReachCourse course;
  engine::ReachInput input;
  input.step_s = kStep_s;
  input.clip_now = hand.at(trial.start_s);
  input.clip_at_arrival = hand.at(trial.start_s + trial.length_s);
  input.arrive_s = trial.length_s;
  input.target = trial.target;
  input.target->world_from_hand = glm::dquat(0.8, 0.6, 0.0, 0.0);
  constexpr int kRuns = 2000;
  int steps = 0;
  const Stopwatch watch;
  for (int run = 0; run < kRuns; ++run) {
    course.start(0.0, input.clip_now, {});
    for (input.time_s = kStep_s; input.time_s < 0.4; input.time_s += kStep_s) {
      (void)course.step(input);
      ++steps;
    }
  }
  char note[80];
  std::snprintf(note,
                sizeof note,
                "A step with orientation takes %.2f us.",
                1e6 * watch.seconds() / steps);
  table.notes.emplace_back(note);
  print_table(table);
}

struct JudgedThrow {
  glm::dvec3 wrist_m{0.0};
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  double speed_m_s = 0.0;
};

// From places of the wrist and rotations of the clip, by differences.
JudgedThrow judge(const CapturedHand& hand,
                  const SampledWay& way,
                  double start_s,
                  double release_s,
                  const glm::dvec3& lever) {
  constexpr double kE_s = 1e-4;
  const glm::dvec3 turn = hand.at(release_s).turn_rad_s;
  const glm::dvec3 arm = hand.at(release_s).world_from_hand * lever;
  const glm::dvec3 arm_rate = (rotation_from_vector(kE_s * turn) * arm - arm) / kE_s;
  const glm::dvec3 velocity = way.velocity(release_s - start_s) + arm_rate;
  const engine::RootPlace root = hand.root(release_s);
  const double sine = std::sin(root.heading_rad);
  const double cosine = std::cos(root.heading_rad);
  const auto in_heading = [&](const glm::dvec3& v) {
    return glm::dvec3(cosine * v.x - sine * v.z, v.y, sine * v.x + cosine * v.z);
  };
  const glm::dvec3 v = in_heading(velocity);
  return {in_heading(way.place(release_s - start_s, release_s - start_s) -
                     glm::dvec3(root.x_m, 0.0, root.z_m)),
          std::atan2(v.x, v.z),
          std::asin(v.y / glm::length(v)),
          glm::length(v)};
}

engine::ThrowChanges throw_wish(const engine::ThrowParameters& captured,
                                std::size_t parameter,
                                double by) {
  engine::ThrowChanges wish;
  const glm::dvec3 wrist = captured.wrist_in_heading_m;
  if (parameter == 0) wish.x_m = wrist.x + 0.15 * by;
  if (parameter == 1) wish.y_m = wrist.y + 0.15 * by;
  if (parameter == 2) wish.z_m = wrist.z + 0.15 * by;
  if (parameter == 3) wish.azimuth_rad = captured.azimuth_rad + 0.35 * by;
  if (parameter == 4) wish.elevation_rad = captured.elevation_rad + 0.25 * by;
  if (parameter == 5) wish.speed_m_s = captured.speed_m_s * (1.0 + 0.4 * by);
  if (parameter == 6) wish.release_s = captured.release_s + 0.08 * by;
  return wish;
}

void measure_throws(const CapturedHand& hand, const glm::dvec3& lever) {
  double captured_s = 0.5;
  for (double t = 0.5; t < hand.duration_s() - 1.0; t += 1.0 / 240) {
    if (glm::length(hand.at(t).velocity_m_s) >
        glm::length(hand.at(captured_s).velocity_m_s)) {
      captured_s = t;
    }
  }
  const auto thrower = [&](double t) {
    return engine::ThrowInstant{hand.at(t), hand.root(t), lever};
  };
  const engine::ThrowParameters captured =
      engine::measure_throw(thrower(captured_s), captured_s);
  ResultTable table{"throw",
                    "CMU 02_05 as a throw, worst of 9 values; judged from places",
                    {{"parameter", 0},
                     {"place mm", 3},
                     {"direction deg", 4},
                     {"speed %", 4},
                     {"release ms", 4}},
                    {},
                    {}};
  const std::vector<std::string> names{
      "x", "y", "z", "azimuth", "elevation", "speed", "instant"};
  const double step_s = 1.0 / 1920;
  for (std::size_t parameter = 0; parameter < names.size(); ++parameter) {
    double place_mm = 0.0, angle_deg = 0.0, speed = 0.0, late_ms = 0.0;
    for (int value = -4; value <= 4; ++value) {
      const engine::ThrowChanges wish = throw_wish(captured, parameter, value / 4.0);
      const engine::ThrowParameters asked = engine::with_changes(captured, wish);
      const double start_s = asked.release_s - 0.5;
      engine::ThrowCourse course;
      course.start(0.0, captured, wish);
      SampledWay way{step_s, {hand.at(start_s).p_in_world}};
      double released_s = 0.0;
      for (int i = 1; i * step_s < 0.9; ++i) {
        engine::ThrowInput input;
        input.time_s = i * step_s;
        input.step_s = step_s;
        input.clip_now = hand.at(start_s + input.time_s);
        input.clip_at_release = thrower(asked.release_s);
        input.release_s = 0.5;
        const engine::ThrowOutput output = course.step(input);
        way.places.push_back(output.wrist.p_in_world);
        if (output.release) released_s = output.release->time_s;
      }
      const JudgedThrow is = judge(hand, way, start_s, asked.release_s, lever);
      place_mm =
          std::max(place_mm, 1e3 * glm::distance(is.wrist_m, asked.wrist_in_heading_m));
      const double cosine =
          glm::dot(engine::throw_direction(0.0, is.azimuth_rad, is.elevation_rad),
                   engine::throw_direction(0.0, asked.azimuth_rad, asked.elevation_rad));
      angle_deg = std::max(angle_deg, 57.29578 * std::acos(std::min(1.0, cosine)));
      speed = std::max(speed, 100.0 * std::abs(is.speed_m_s / asked.speed_m_s - 1.0));
      late_ms = std::max(late_ms, 1e3 * std::abs(released_s - 0.5));
    }
    table.rows.push_back({names[parameter], place_mm, angle_deg, speed, late_ms});
  }
  char note[120];
  std::snprintf(note,
                sizeof note,
                "Captured: %.2f m/s at %.2f s; half width 0.35 s.",
                captured.speed_m_s,
                captured_s);
  table.notes.emplace_back(note);
  print_table(table);
}

int run(const std::string& shared) {
  const auto reach =
      testing::truth_motion(shared + "/blender/dev/reach/truth/segments.csv");
  if (!reach) fail("no reach below " + shared);
  const double rate_hz = reach->rate.hz;
  measure_reaches(
      CapturedHand(reach->skeleton, reach->poses, rate_hz, HumanBone::kRightHand));
  const auto punch = read_clip(shared + "/mocap/cmu_asfamc/02_05.amc", "punch");
  if (!punch) fail(punch.error().message());
  // At 30 Hz, as clips of the engine.
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < punch->poses.size(); i += 4)
    poses.push_back(punch->poses[i]);
  measure_throws(
      CapturedHand(
          punch->character.skeleton, poses, punch->rate_hz / 4.0, HumanBone::kRightHand),
      {-0.09, -0.03, 0.02});
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc > 1 ? argv[1] : "../shared/data");
}
