// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/floor_at.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::retarget {
namespace {

// A step of 0.2 m, followed by a ramp that rises by 0.3 m in 2 m.
Floor step_and_ramp() {
  Floor floor;
  floor.base_height_m = 0.05;
  floor.parts.push_back({"step", {-1, 1}, {1, 2}, 0.2, {0, 0}, {}});
  floor.parts.push_back({"ramp", {-1, 2}, {1, 4}, 0.35, {0, 0.15}, {}});
  return floor;
}

TEST(FloorAt, IsTheHighestPartThereElseTheBase) {
  Floor floor = step_and_ramp();
  EXPECT_EQ(floor_at(floor, {0, 0}, 0.0).height_m, 0.05);
  EXPECT_FALSE(floor_at(floor, {0, 0}, 0.0).part);
  EXPECT_EQ(floor_at(floor, {0, 1}, 0.0).height_m, 0.2) << "edges belong to the part";
  EXPECT_EQ(floor_at(floor, {0, 0.999}, 0.0).height_m, 0.05);
  EXPECT_EQ(floor_at(floor, {1.01, 1.5}, 0.0).height_m, 0.05);
  EXPECT_EQ(floor_at(floor, {0, 2}, 0.0).part, FloorPartIndex(0)) << "first of equals";
  EXPECT_NEAR(floor_at(floor, {0, 4}, 0.0).height_m, 0.5, 1e-12);
  floor.parts.push_back({"pit", {-1, -2}, {1, -1}, -0.4, {0, 0}, {}});
  EXPECT_EQ(floor_at(floor, {0, -1.5}, 0.0).height_m, -0.4) << "parts may be below";
}

TEST(FloorAt, NormalsStandOnThePlane) {
  const Floor floor = step_and_ramp();
  EXPECT_EQ(floor_at(floor, {0, 1.5}, 0.0).normal_in_world, glm::dvec3(0, 1, 0));
  const glm::dvec3 normal = floor_at(floor, {0, 3}, 0.0).normal_in_world;
  EXPECT_NEAR(glm::length(normal), 1.0, 1e-12);
  EXPECT_NEAR(std::atan2(-normal.z, normal.y), std::atan(0.15), 1e-12);
}

TEST(FloorAt, PlanesGoOnBeyondTheirEdges) {
  const Floor floor = step_and_ramp();
  EXPECT_NEAR(plane_at(floor, 1, {5, 6}, 0.0).height_m, 0.8, 1e-12);
  EXPECT_EQ(plane_at(floor, std::nullopt, {0, 3}, 0.0).height_m, 0.05);
}

// Forward, wait, on at constant speed, and back.
FloorPart lift() {
  FloorPart part{"lift", {-1, -1}, {1, 1}, 0.1, {0, 0}, {}};
  part.path = {{1.0, {0, 0, 0}},
               {2.0, {0, 0.5, 0}},
               {3.0, {0, 0.5, 1}},
               {4.0, {0, 0.5, 2}},
               {5.0, {0, 0, 3}}};
  return part;
}

TEST(FloorAt, MovingPartsPassTheirKeysAndRestBeforeAndAfter) {
  const FloorPart part = lift();
  for (const FloorKey& key : part.path) {
    EXPECT_LT(glm::distance(moved_at(part, key.time_s), key.moved_m), 1e-12);
  }
  EXPECT_EQ(moved_at(part, -7.0), glm::dvec3(0.0));
  EXPECT_EQ(moved_at(part, 9.0), glm::dvec3(0, 0, 3));
  EXPECT_NEAR(moved_at(part, 3.3).z, 1.3, 1e-12) << "steady speed is kept";
  for (double t = 2.0; t <= 4.0; t += 0.01) {
    EXPECT_NEAR(moved_at(part, t).y, 0.5, 1e-12) << "no overshoot at " << t;
  }
  const Floor floor{0.0, {part}};
  EXPECT_NEAR(floor_at(floor, {0, 3.5}, 5.0).height_m, 0.1, 1e-12);
  EXPECT_FALSE(floor_at(floor, {0, -0.5}, 5.0).part) << "it is not there any more";
}

// Second differences over 1 ms differ from one to the next by the jerk (at most 60 m/s3
// for a metre in a second, a quintic's) times 1 ms, and by roundings of 1e-16 / 1e-6.
TEST(FloorAt, MovesWithContinuousSpeedAndAcceleration) {
  const FloorPart part = lift();
  constexpr double kStep_s = 1e-3;
  const auto acceleration = [&](double t) {
    return (moved_at(part, t + kStep_s) - 2.0 * moved_at(part, t) +
            moved_at(part, t - kStep_s)) /
           (kStep_s * kStep_s);
  };
  double largest = 0.0;
  for (double t = 0.5; t < 5.5; t += kStep_s) {
    EXPECT_LT(glm::distance(acceleration(t), acceleration(t + kStep_s)), 0.1) << t;
    largest = std::max(largest, glm::length(acceleration(t)));
  }
  EXPECT_GT(largest, 2.0) << "it did not move";
}

}  // namespace
}  // namespace marey::retarget
