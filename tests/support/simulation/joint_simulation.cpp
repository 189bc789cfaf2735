// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/joint_simulation.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/transform.h"

namespace marey::testing {
namespace {

constexpr double kHalf_m = 0.05;
constexpr double kAway_m = 0.15;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}
  double even() { return even_(generator_); }
  double normal() { return normal_(generator_); }
  glm::dvec3 vector() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }

 private:
  std::mt19937_64 generator_;
  std::uniform_real_distribution<double> even_{0.0, 1.0};
  std::normal_distribution<double> normal_{0.0, 1.0};
};

std::vector<glm::dvec3> random_turns(const JointSimulationOptions& options, Dice& dice) {
  std::vector<glm::dvec3> turns;
  for (int f = 0; f < options.frames; ++f) {
    const double angle =
        0.5 * options.cone_rad * (options.around_rim ? 1.0 : std::sqrt(dice.even()));
    const double way = 2.0 * std::numbers::pi * dice.even();
    turns.push_back(angle * glm::dvec3(std::cos(way), 0.0, std::sin(way)));
  }
  return turns;
}

/// A matrix per marker, so scaled that all move by the asked root mean square.
std::vector<glm::dmat3> random_tissue(const JointSimulationOptions& options,
                                      const std::vector<glm::dvec3>& turns,
                                      std::size_t markers,
                                      Dice& dice) {
  std::vector<glm::dmat3> tissue;
  double sum = 0.0;
  for (std::size_t m = 0; m < markers; ++m) {
    const glm::dvec3 x = dice.vector();
    const glm::dvec3 y = dice.vector();
    tissue.emplace_back(x, y, dice.vector());
    for (const glm::dvec3& turn : turns) {
      sum += glm::dot(tissue.back() * turn, tissue.back() * turn);
    }
  }
  const double rms = std::sqrt(sum / static_cast<double>(markers * turns.size()));
  for (glm::dmat3& one : tissue) one *= options.soft_tissue_m / rms;
  return tissue;
}

}  // namespace

JointSimulation simulate_joint(const JointSimulationOptions& options) {
  Dice dice(options.seed);
  JointSimulation s;
  s.shape_in_a = {{kHalf_m, kHalf_m, kHalf_m},
                  {kHalf_m, -kHalf_m, -kHalf_m},
                  {-kHalf_m, kHalf_m, -kHalf_m},
                  {-kHalf_m, -kHalf_m, kHalf_m}};
  s.shape_in_b = s.shape_in_a;
  s.joint_in_a = {0.0, -kAway_m, 0.0};
  s.joint_in_b = {0.0, kAway_m, 0.0};
  const auto turns = random_turns(options, dice);
  const auto tissue = random_tissue(options, turns, JointSimulation::kMarkers, dice);
  const auto see = [&](const glm::dvec3& p,
                       std::vector<std::optional<glm::dvec3>>& cluster) {
    const glm::dvec3 seen = p + options.noise_m * dice.vector();
    const bool dropped = dice.even() < options.dropouts;
    cluster.push_back(dropped ? std::nullopt : std::optional(seen));
  };
  for (const glm::dvec3& turn : turns) {
    const glm::dvec3 attitude = 0.3 * dice.vector();
    const RigidTransform world_from_a{rotation_from_vector(attitude),
                                      0.2 * dice.vector()};
    const glm::dquat a_from_b = rotation_from_vector(turn);
    for (const glm::dvec3& p : s.shape_in_a) see(world_from_a * p, s.a_in_world);
    for (std::size_t m = 0; m < JointSimulation::kMarkers; ++m) {
      const glm::dvec3 p_in_b = s.shape_in_b[m] + tissue[m] * turn;
      see(world_from_a * (s.joint_in_a + a_from_b * (p_in_b - s.joint_in_b)),
          s.b_in_world);
    }
  }
  return s;
}

}  // namespace marey::testing
