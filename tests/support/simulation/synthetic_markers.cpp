// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/synthetic_markers.h"

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "core/transform.h"

namespace marey::testing {
namespace {

constexpr std::array<glm::dvec3, kMarkersOfPart> kShape{glm::dvec3{0.05, 0.0, 0.03},
                                                        glm::dvec3{-0.06, 0.05, 0.0},
                                                        glm::dvec3{0.02, 0.12, 0.05},
                                                        glm::dvec3{-0.03, 0.16, -0.05},
                                                        glm::dvec3{0.06, 0.21, -0.02}};

/// Returns the pose of part `part`; 1 and 2, 3 and 4 are limbs that hang on the trunk, 0.
RigidTransform world_from_part(std::size_t part, double t) {
  const RigidTransform trunk{
      rotation_from_vector({0.2 * std::sin(1.1 * t), 0.8 * std::sin(0.7 * t), 0.1}),
      glm::dvec3(0.5 * std::sin(0.9 * t), 1.0 + 0.05 * std::sin(5.0 * t), 0.3 * t)};
  if (part == 0) return trunk;
  const double side = part < 3 ? 1.0 : -1.0;
  const RigidTransform upper{
      rotation_from_vector({1.2 * std::sin(3.0 * t + side), 0.0, side * 0.9}),
      glm::dvec3(side * 0.18, 0.4, 0.0)};
  if (part % 2 == 1) return trunk * upper;
  const RigidTransform lower{
      rotation_from_vector({-0.8 - 0.7 * std::sin(3.0 * t + 2.0 * side), 0.0, 0.0}),
      glm::dvec3(0.0, -0.3, 0.0)};
  return trunk * upper * lower;
}

}  // namespace

MarkerTracks synthetic_markers(std::size_t frames, double noise_m) {
  MarkerTracks tracks;
  tracks.rate.hz = 100.0;
  for (std::size_t m = 0; m < kSyntheticParts * kMarkersOfPart; ++m) {
    tracks.labels.push_back(std::string("M").append(std::to_string(m)));
  }
  std::mt19937_64 generator(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t part = 0; part < kSyntheticParts; ++part) {
      const RigidTransform pose = world_from_part(part, static_cast<double>(f) / 100.0);
      for (const glm::dvec3& p : kShape) {
        MarkerSample sample;
        sample.p_in_world = pose * p;
        for (int axis = 0; axis < 3; ++axis) {
          sample.p_in_world[axis] += noise_m * noise(generator);
        }
        tracks.samples.emplace_back(sample);
      }
    }
  }
  return tracks;
}

}  // namespace marey::testing
