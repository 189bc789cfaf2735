// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "engine/models/hand_motion.h"
#include "engine/models/reach_course.h"
#include <glm/geometric.hpp>

namespace marey::testing {

inline glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const glm::dvec3 v(normal(random), normal(random), normal(random));
  return glm::normalize(v + glm::dvec3(1e-6, 0.0, 0.0));
}

inline double random_between(std::mt19937& random, double min, double max) {
  return std::uniform_real_distribution<double>(min, max)(random);
}

/// A smooth movement of a hand: sums of sines in place and rotation.
class MadeHand {
 public:
  explicit MadeHand(std::mt19937& random) {
    for (Wave& wave : waves_) {
      wave.place_m = random_between(random, 0.03, 0.15) * random_direction(random);
      wave.turn_rad = random_between(random, 0.05, 0.4) * random_direction(random);
      wave.rad_s = random_between(random, 2.0, 6.0);
      wave.phase_rad = random_between(random, 0.0, 6.28);
    }
  }

  [[nodiscard]] RigidTransform frame(double time_s) const {
    glm::dvec3 place(0.2, 1.2, 0.4);
    glm::dvec3 turn(0.0);
    for (const Wave& wave : waves_) {
      const double sine = std::sin(wave.rad_s * time_s + wave.phase_rad);
      place += sine * wave.place_m;
      turn += sine * wave.turn_rad;
    }
    return {rotation_from_vector(turn), place};
  }

  [[nodiscard]] engine::HandMotion at(double time_s) const {
    constexpr double kStep_s = 1e-4;
    engine::HandMotion hand = engine::hand_motion(
        frame(time_s - kStep_s), frame(time_s), frame(time_s + kStep_s), kStep_s);
    hand.velocity_m_s = glm::dvec3(0.0);
    hand.acceleration_m_s2 = glm::dvec3(0.0);
    for (const Wave& wave : waves_) {
      const double angle = wave.rad_s * time_s + wave.phase_rad;
      hand.velocity_m_s += wave.rad_s * std::cos(angle) * wave.place_m;
      hand.acceleration_m_s2 -= wave.rad_s * wave.rad_s * std::sin(angle) * wave.place_m;
    }
    return hand;
  }

 private:
  struct Wave {
    glm::dvec3 place_m{0.0};
    glm::dvec3 turn_rad{0.0};
    double rad_s = 0.0;
    double phase_rad = 0.0;
  };
  std::array<Wave, 3> waves_{};
};

/// A way by its places at steady times, and an independent judge of it: knows nothing of
/// the course that made it, and derives velocities and accelerations from places alone.
struct JudgedWay {
  double start_s = 0.0;
  double step_s = 0.0;
  std::vector<glm::dvec3> places;

  [[nodiscard]] double time_s(std::size_t i) const {
    return start_s + static_cast<double>(i) * step_s;
  }
  /// Place at a time, on the polynomial through the six samples that end at `last`.
  [[nodiscard]] glm::dvec3 place(double at_s, std::size_t last) const {
    glm::dvec3 sum(0.0);
    for (std::size_t i = last - 5; i <= last; ++i) {
      double weight = 1.0;
      for (std::size_t j = last - 5; j <= last; ++j) {
        if (j != i) weight *= (at_s - time_s(j)) / (time_s(i) - time_s(j));
      }
      sum += weight * places[i];
    }
    return sum;
  }
  /// Last sample that is not after a time.
  [[nodiscard]] std::size_t before(double at_s) const {
    return static_cast<std::size_t>(std::floor((at_s - start_s) / step_s + 1e-6));
  }
  [[nodiscard]] glm::dvec3 velocity_before(double at_s) const {
    const std::size_t last = before(at_s);
    const double e = 1e-4;
    return (place(at_s + e, last) - place(at_s - e, last)) / (2.0 * e);
  }
  [[nodiscard]] glm::dvec3 acceleration(std::size_t i) const {
    return (places[i + 1] - 2.0 * places[i] + places[i - 1]) / (step_s * step_s);
  }
  [[nodiscard]] double max_acceleration(double until_s) const {
    double max = 0.0;
    for (std::size_t i = 1; i + 1 < places.size() && time_s(i) < until_s; ++i) {
      max = std::max(max, glm::length(acceleration(i)));
    }
    return max;
  }
  /// Maximum change of the acceleration between two samples.
  [[nodiscard]] double max_jump() const {
    double max = 0.0;
    for (std::size_t i = 1; i + 2 < places.size(); ++i) {
      max = std::max(max, glm::length(acceleration(i + 1) - acceleration(i)));
    }
    return max;
  }
};

/// Plays a reach with a hand and a target; the hand's clip is not slowed.
template <class TargetAt>
JudgedWay play_reach(const MadeHand& hand,
                     double arrive_s,
                     double end_s,
                     double step_s,
                     const engine::ReachOptions& options,
                     const TargetAt& target_at,
                     std::vector<engine::ReachOutput>* outputs = nullptr) {
  engine::ReachCourse course;
  course.start(0.0, hand.at(0.0), options);
  JudgedWay way{0.0, step_s, {hand.at(0.0).p_in_world}};
  for (int i = 1; i * step_s <= end_s; ++i) {
    engine::ReachInput input;
    input.time_s = i * step_s;
    input.step_s = step_s;
    input.clip_now = hand.at(input.time_s);
    input.clip_at_arrival = hand.at(arrive_s);
    input.arrive_s = arrive_s;
    input.clip_remaining_s = std::max(0.0, arrive_s - input.time_s);
    input.target = target_at(input.time_s);
    const engine::ReachOutput output = course.step(input);
    way.places.push_back(output.hand.p_in_world);
    if (outputs != nullptr) outputs->push_back(output);
  }
  return way;
}

}  // namespace marey::testing
