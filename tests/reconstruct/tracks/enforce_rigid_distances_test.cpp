// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/enforce_rigid_distances.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::reconstruct {
namespace {

constexpr std::size_t kFrames = 200;
constexpr std::size_t kLost = 100;

/// Three markers at steady distances that move through the room; the last is missing in
/// one frame, with the estimate `guess` and the standard deviation `sigma_m`.
struct Scene {
  MarkerTracks measured;
  MarkerTracks repaired;
};

glm::dvec3 place(std::size_t marker, std::size_t frame) {
  const std::array<glm::dvec3, 3> shape{
      {{0.0, 0.0, 0.0}, {0.0, 0.01, 0.0}, {0.3, 0.0, 0.0}}};
  return shape[marker] + glm::dvec3(0.01 * static_cast<double>(frame), 0.0, 0.0);
}

Scene scene_with(const glm::dvec3& guess, float sigma_m) {
  Scene scene;
  scene.measured.labels = {"A", "B", "C"};
  scene.measured.rate = FrameRate{100.0};
  for (std::size_t f = 0; f < kFrames; ++f) {
    for (std::size_t m = 0; m < 3; ++m) {
      MarkerSample sample;
      sample.p_in_world = place(m, f);
      scene.measured.samples.emplace_back(sample);
    }
  }
  scene.measured.at(kLost, 2).reset();
  scene.repaired = scene.measured;
  MarkerSample filled;
  filled.p_in_world = guess;
  filled.sigma_m = sigma_m;
  filled.source = Source::kRepaired;
  scene.repaired.at(kLost, 2) = filled;
  return scene;
}

TEST(EnforceRigidDistances, BringsAFilledMarkerToItsDistances) {
  Scene scene = scene_with(place(2, kLost) + glm::dvec3(0.02, 0.0, 0.0), 0.02F);
  enforce_rigid_distances(
      scene.measured, MarkerDistances(scene.measured), scene.repaired);
  const glm::dvec3 held = scene.repaired.at(kLost, 2)->p_in_world;
  // The distance's millimetre against the marker's twenty.
  EXPECT_NEAR(glm::distance(held, place(0, kLost)), 0.3, 0.001);
}

TEST(EnforceRigidDistances, NeverMovesAMarkerBeyondItsUncertainty) {
  // Two bones with nearly the same direction that contradict each other: their circles
  // meet far away.
  constexpr float kSigma_m = 0.05F;
  Scene scene = scene_with(place(2, kLost) + glm::dvec3(-0.2, 0.003, 0.0), kSigma_m);
  scene.measured.at(kLost, 1)->p_in_world += glm::dvec3(-0.03, 0.0, 0.0);
  scene.repaired.at(kLost, 1) = scene.measured.at(kLost, 1);
  const glm::dvec3 guess = scene.repaired.at(kLost, 2)->p_in_world;
  enforce_rigid_distances(
      scene.measured, MarkerDistances(scene.measured), scene.repaired);
  EXPECT_LE(glm::distance(scene.repaired.at(kLost, 2)->p_in_world, guess),
            1.5 * static_cast<double>(kSigma_m) + 1e-9);
}

TEST(EnforceRigidDistances, LeavesAFilledMarkerThatIsHeldByNoBetterOnes) {
  Scene scene = scene_with(place(2, kLost) + glm::dvec3(0.02, 0.0, 0.0), 0.01F);
  // All three are filled, the other two with much larger sigmas.
  for (std::size_t m = 0; m < 2; ++m) {
    scene.measured.at(kLost, m).reset();
    scene.repaired.at(kLost, m)->sigma_m = 0.5F;
    scene.repaired.at(kLost, m)->source = Source::kRepaired;
  }
  const glm::dvec3 guess = scene.repaired.at(kLost, 2)->p_in_world;
  enforce_rigid_distances(
      scene.measured, MarkerDistances(scene.measured), scene.repaired);
  EXPECT_LT(glm::distance(scene.repaired.at(kLost, 2)->p_in_world, guess), 0.001);
}

}  // namespace
}  // namespace marey::reconstruct
