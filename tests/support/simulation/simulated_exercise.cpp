// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_exercise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/trigonometric.hpp>

namespace marey::testing {
namespace {

constexpr double kFade_s = 0.5;

double eased(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

double value(const AngleWave& w, double t) {
  const double faded = eased((t - w.from_s) / kFade_s) * eased((w.to_s - t) / kFade_s);
  return faded * (w.middle +
                  w.amplitude * std::sin(2.0 * std::numbers::pi * w.hz * (t - w.from_s) +
                                         w.phase_rad));
}

/// Adds waves to an exercise, in degrees.
class Choreography {
 public:
  Choreography(Exercise& exercise, Dice& dice, double size)
      : exercise_(exercise), dice_(dice), size_(size) {}

  /// Sets the interval of the next waves. Draws their frequency and phase.
  void during(double from_s, double to_s) {
    from_s_ = from_s;
    to_s_ = to_s;
    hz_ = dice_.between(0.35, 0.7);
    phase_rad_ = dice_.between(0.0, 2.0 * std::numbers::pi);
  }
  void add(std::size_t angle, double middle_deg, double amplitude_deg, double lag = 0.0) {
    const double own = size_ * dice_.between(0.8, 1.2);
    exercise_.waves.push_back({angle,
                               own * glm::radians(middle_deg),
                               own * glm::radians(amplitude_deg),
                               hz_,
                               phase_rad_ - lag * 2.0 * std::numbers::pi,
                               from_s_,
                               to_s_});
  }
  void add(Angle angle, double middle_deg, double amplitude_deg, double lag = 0.0) {
    add(index(angle), middle_deg, amplitude_deg, lag);
  }
  void limb(std::size_t limb,
            LimbAngle angle,
            double middle_deg,
            double amplitude_deg,
            double lag = 0.0) {
    add(limb_angle(limb, angle), middle_deg, amplitude_deg, lag);
  }

  void arms_circle() {
    for (const std::size_t arm : {0U, 1U}) {
      limb(arm, LimbAngle::kRaise, 55, 50);
      limb(arm, LimbAngle::kSwing, 25, 40, 0.25);
      limb(arm, LimbAngle::kSpin, 0, 35, 0.4);
    }
  }
  void elbows_bend() {
    for (const std::size_t arm : {0U, 1U}) {
      limb(arm, LimbAngle::kRaise, 25, 10);
      limb(arm, LimbAngle::kBend, 60, 58, arm == 0 ? 0.0 : 0.5);
    }
  }
  void forearms_turn() {
    for (const std::size_t arm : {0U, 1U}) {
      limb(arm, LimbAngle::kSwing, 20, 5);
      limb(arm, LimbAngle::kBend, 75, 10);
      limb(arm, LimbAngle::kTwist, 15, 60, arm == 0 ? 0.0 : 0.3);
    }
  }
  void wrists_circle() {
    for (const std::size_t arm : {0U, 1U}) {
      limb(arm, LimbAngle::kBend, 70, 15);
      limb(arm, LimbAngle::kEndFlexion, 5, 45);
      limb(arm, LimbAngle::kEndDeviation, 0, 20, 0.25);
    }
  }
  void trunk_moves() {
    add(Angle::kTrunkX, 18, 22);
    add(Angle::kTrunkY, 0, 30, 0.3);
    add(Angle::kTrunkZ, 0, 18, 0.6);
  }
  void head_moves() {
    add(Angle::kHeadX, 0, 28);
    add(Angle::kHeadY, 0, 45, 0.3);
    add(Angle::kHeadZ, 0, 18, 0.55);
  }
  void leg_moves(std::size_t leg) {
    limb(leg, LimbAngle::kSwing, 30, 32);
    limb(leg, LimbAngle::kRaise, 14, 14, 0.25);
    limb(leg, LimbAngle::kSpin, 0, 15, 0.4);
    limb(leg, LimbAngle::kBend, 45, 42, 0.1);
    limb(leg, LimbAngle::kEndFlexion, 0, 22, 0.3);
    limb(leg, LimbAngle::kEndDeviation, 0, 10, 0.55);
  }
  void squats() {
    for (const std::size_t leg : {2U, 3U}) {
      limb(leg, LimbAngle::kSwing, 38, 34);
      limb(leg, LimbAngle::kBend, 46, 42);
      limb(leg, LimbAngle::kRaise, 8, 3);
    }
    add(Angle::kTrunkX, 12, 10);
  }

 private:
  Exercise& exercise_;
  Dice& dice_;
  double size_;
  double from_s_ = 0.0;
  double to_s_ = 0.0;
  double hz_ = 0.5;
  double phase_rad_ = 0.0;
};

constexpr int kBlocks = 9;

void dance(Choreography& steps, int block) {
  switch (block) {
    case 0:
      return steps.arms_circle();
    case 1:
      return steps.elbows_bend();
    case 2:
      return steps.forearms_turn();
    case 3:
      return steps.wrists_circle();
    case 4:
      return steps.trunk_moves();
    case 5:
      return steps.head_moves();
    case 6:
      return steps.leg_moves(2);
    case 7:
      return steps.leg_moves(3);
    default:
      return steps.squats();
  }
}

/// Draws a posture at ease. Its limbs are slightly bent.
Attitude at_ease(Dice& dice, double heading_rad) {
  Attitude a{};
  a[index(Angle::kHeading)] = heading_rad + dice.noise(0.1);
  a[index(Angle::kTrunkX)] = dice.noise(0.04);
  a[index(Angle::kHipsTilt)] = dice.noise(0.04);
  a[index(Angle::kHeadX)] = dice.noise(0.06);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const auto set = [&](LimbAngle angle, double low_deg, double high_deg) {
      a[limb_angle(limb, angle)] = glm::radians(dice.between(low_deg, high_deg));
    };
    if (limb < 2) {
      set(LimbAngle::kRaise, 8, 18);
      set(LimbAngle::kBend, 5, 18);
      set(LimbAngle::kTwist, -15, 25);
      set(LimbAngle::kSwing, -4, 8);
    } else {
      set(LimbAngle::kRaise, 2, 7);
      set(LimbAngle::kSpin, 3, 14);
      set(LimbAngle::kBend, 1, 8);
      a[limb_angle(limb, LimbAngle::kSwing)] =
          0.5 * a[limb_angle(limb, LimbAngle::kBend)];
    }
  }
  return a;
}

void add_sway(Exercise& exercise, Dice& dice) {
  const auto sway = [&](Angle angle, double maximum) {
    exercise.waves.push_back({index(angle),
                              0.0,
                              dice.between(0.2, 1.0) * maximum,
                              dice.between(0.2, 0.6),
                              dice.between(0.0, 2.0 * std::numbers::pi),
                              -10.0,
                              exercise.duration_s + 10.0});
  };
  sway(Angle::kFloorX, 0.008);
  sway(Angle::kFloorZ, 0.010);
  sway(Angle::kHipsTilt, 0.02);
  sway(Angle::kTrunkX, 0.02);
  sway(Angle::kTrunkZ, 0.015);
  sway(Angle::kHeadX, 0.03);
}

void turn_around(Exercise& exercise, Dice& dice, double max_rad) {
  exercise.waves.push_back({index(Angle::kHeading),
                            0.0,
                            dice.between(0.2, 1.0) * max_rad,
                            dice.between(1.0, 2.0) / exercise.duration_s,
                            dice.between(0.0, 2.0 * std::numbers::pi),
                            -10.0,
                            exercise.duration_s + 10.0});
}

void walk(Exercise& exercise, Dice& dice) {
  const double cycle_s = dice.between(1.0, 1.3);
  const double speed = dice.between(0.6, 1.0);
  constexpr double kMaxDistance_m = 2.4;
  exercise.duration_s = std::min(exercise.duration_s, kMaxDistance_m / speed);
  const double heading = exercise.base[index(Angle::kHeading)];
  exercise.velocity_m = speed * glm::dvec2(std::sin(heading), std::cos(heading));
  const glm::dvec2 start = -0.5 * exercise.duration_s * exercise.velocity_m;
  exercise.base[index(Angle::kFloorX)] = start.x;
  exercise.base[index(Angle::kFloorZ)] = start.y;
  const auto add = [&](std::size_t angle, double middle, double amplitude, double lag) {
    exercise.waves.push_back({angle,
                              glm::radians(middle),
                              glm::radians(amplitude),
                              1.0 / cycle_s,
                              -2.0 * std::numbers::pi * lag,
                              -10.0,
                              exercise.duration_s + 10.0});
  };
  for (std::size_t limb = 0; limb < 4; ++limb) {
    // The left arm goes with the right leg.
    const double lag = (limb == 0 || limb == 3) ? 0.5 : 0.0;
    if (limb < 2) {
      add(limb_angle(limb, LimbAngle::kSwing), 3, 22, lag);
      add(limb_angle(limb, LimbAngle::kBend), 20, 12, lag + 0.1);
    } else {
      add(limb_angle(limb, LimbAngle::kSwing), 10, 24, lag);
      add(limb_angle(limb, LimbAngle::kBend), 30, 28, lag - 0.2);
      add(limb_angle(limb, LimbAngle::kEndFlexion), 0, 15, lag - 0.4);
    }
  }
  add(index(Angle::kTrunkY), 0, 8, 0.1);
  add(index(Angle::kHipsList), 0, 3, 0.3);
}

void reach(Exercise& exercise, Dice& dice) {
  Choreography steps(exercise, dice, 1.0);
  double t = 0.1;
  while (t < exercise.duration_s - 0.8) {
    const std::size_t arm = dice.between(0, 1) < 0.5 ? 0 : 1;
    steps.during(t, t + 1.6);
    steps.limb(arm, LimbAngle::kSwing, dice.between(40, 100), 12);
    steps.limb(arm, LimbAngle::kRaise, dice.between(0, 40), 8);
    steps.limb(arm, LimbAngle::kBend, dice.between(0, 25), 10);
    steps.add(Angle::kTrunkX, dice.between(0, 25), 4);
    steps.add(Angle::kTrunkY, dice.between(-20, 20), 4);
    t += 1.2;
  }
}

}  // namespace

Attitude Exercise::at(double time_s) const {
  Attitude a = base;
  for (const AngleWave& wave : waves) a[wave.angle] += value(wave, time_s);
  a[index(Angle::kFloorX)] += velocity_m.x * time_s;
  a[index(Angle::kFloorZ)] += velocity_m.y * time_s;
  for (std::size_t limb = 0; limb < 4; ++limb) {
    // No joint bends the wrong way, nor folds into itself.
    double& bend = a[limb_angle(limb, LimbAngle::kBend)];
    bend = std::clamp(bend, limb < 2 ? 0.0 : -0.03, 2.4);
  }
  return a;
}

Exercise draw_standing(Dice& dice, double heading_rad) {
  Exercise exercise;
  exercise.duration_s = dice.between(1.0, 3.0);
  exercise.base = at_ease(dice, heading_rad);
  const bool is_t_pose = dice.between(0, 1) < 0.5;
  exercise.name = is_t_pose ? "T pose" : "A pose";
  for (const std::size_t arm : {0U, 1U}) {
    exercise.base[limb_angle(arm, LimbAngle::kRaise)] =
        glm::radians(is_t_pose ? dice.between(78, 95) : dice.between(18, 50));
  }
  add_sway(exercise, dice);
  return exercise;
}

Exercise draw_range_of_motion(Dice& dice, Diligence diligence, double heading_rad) {
  Exercise exercise;
  exercise.base = at_ease(dice, heading_rad);
  if (diligence == Diligence::kLazy) {
    exercise.name = "lazy range of motion";
    exercise.duration_s = 6.0;
    Choreography steps(exercise, dice, dice.between(0.15, 0.45));
    for (int block = 0; block < kBlocks; ++block) {
      if (dice.between(0, 1) < 0.35) continue;
      const double from_s = dice.between(0.0, 2.5);
      steps.during(from_s, from_s + dice.between(2.5, 3.5));
      dance(steps, block);
    }
    add_sway(exercise, dice);
    turn_around(exercise, dice, 0.4);
    return exercise;
  }
  exercise.name = "range of motion";
  exercise.duration_s = dice.between(20.0, 40.0);
  std::vector<int> order;
  for (int block = 0; block < kBlocks; ++block) order.push_back(block);
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    std::swap(
        order[i],
        order[static_cast<std::size_t>(dice.between(0, static_cast<double>(i) + 1))]);
  }
  Choreography steps(exercise, dice, dice.between(0.75, 1.05));
  const double each_s = (exercise.duration_s - 1.0) / kBlocks;
  for (int i = 0; i < kBlocks; ++i) {
    const double from_s = 0.5 + i * each_s;
    steps.during(from_s, from_s + each_s * dice.between(0.9, 1.2));
    dance(steps, order[static_cast<std::size_t>(i)]);
  }
  add_sway(exercise, dice);
  turn_around(exercise, dice, dice.between(0, 1) < 0.5 ? 0.8 : 2.5);
  return exercise;
}

Exercise draw_motion(Dice& dice, double heading_rad) {
  Exercise exercise;
  exercise.duration_s = dice.between(2.0, 4.0);
  exercise.base = at_ease(dice, heading_rad);
  const double kind = dice.between(0.0, 4.0);
  if (kind < 1.0) {
    exercise.name = "walk";
    exercise.base[index(Angle::kHeading)] += dice.between(-0.8, 0.8);
    walk(exercise, dice);
  } else if (kind < 2.0) {
    exercise.name = "reach";
    reach(exercise, dice);
  } else {
    Choreography steps(exercise, dice, 1.0);
    steps.during(-1.0, exercise.duration_s + 1.0);
    if (kind < 3.0) {
      exercise.name = "squat";
      steps.squats();
    } else {
      exercise.name = "arm swings";
      steps.arms_circle();
      steps.during(-1.0, exercise.duration_s + 1.0);
      steps.add(Angle::kTrunkY, 0, 15);
    }
  }
  add_sway(exercise, dice);
  return exercise;
}

}  // namespace marey::testing
