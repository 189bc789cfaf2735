// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/root_anchor.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

constexpr double kUnit_m = 0.9;

FootPlaces feet_at(double left_z) {
  FootPlaces feet;
  feet.ankle = {glm::dvec3(0.1, -0.9, left_z), glm::dvec3(-0.1, -0.8, -left_z)};
  feet.ball = {glm::dvec3(0.1, -0.95, left_z + 0.1), glm::dvec3(-0.1, -0.8, -left_z)};
  return feet;
}

glm::dvec2 in_world(const RootPlace& root, const glm::dvec3& p_legs) {
  const double c = std::cos(root.heading_rad);
  const double s = std::sin(root.heading_rad);
  return {root.x_m + kUnit_m * (c * p_legs.x + s * p_legs.z),
          root.z_m + kUnit_m * (c * p_legs.z - s * p_legs.x)};
}

TEST(RootAnchor, KeepsASingleBearingFootStill) {
  RootAnchor anchor;
  anchor.observe({1.0, 0.0, 0.0, 0.0}, 0.1);
  const RootPlace root{1.0, 2.0, 0.7};
  const RootPlace blended{0.02, 0.05, 0.04};
  const FootPlaces before = feet_at(0.2);
  const FootPlaces now = feet_at(0.17);
  const RootPlace by = anchor.displacement(blended, before, now, kUnit_m, 1.0);
  EXPECT_DOUBLE_EQ(by.heading_rad, blended.heading_rad);
  const RootPlace after = moved(root, by);
  const glm::dvec2 was = in_world(root, before.ankle[0]);
  const glm::dvec2 is = in_world(after, now.ankle[0]);
  EXPECT_NEAR(is.x, was.x, 1e-12);
  EXPECT_NEAR(is.y, was.y, 1e-12);
}

TEST(RootAnchor, LeavesTheBlendWithoutStrengthOrSupport) {
  RootAnchor anchor;
  const RootPlace blended{0.02, 0.05, 0.04};
  const RootPlace free =
      anchor.displacement(blended, feet_at(0.2), feet_at(0.1), kUnit_m, 1.0);
  EXPECT_EQ(free.x_m, blended.x_m);
  EXPECT_EQ(free.z_m, blended.z_m);
  anchor.observe({1.0, 1.0, 0.0, 0.0}, 0.1);
  const RootPlace weak =
      anchor.displacement(blended, feet_at(0.2), feet_at(0.1), kUnit_m, 0.0);
  EXPECT_EQ(weak.x_m, blended.x_m);
}

TEST(RootAnchor, FiltersTheSharesOfBearing) {
  RootAnchor anchor;
  anchor.observe({0.0, 0.0, 0.0, 0.0}, 0.01);
  double last = 0.0;
  for (int i = 0; i < 30; ++i) {
    anchor.observe({1.0, 0.0, 0.0, 0.0}, 0.01);
    EXPECT_GT(anchor.bears()[0], last);
    last = anchor.bears()[0];
  }
  EXPECT_NEAR(last, 1.0 - std::exp(-0.3 / RootAnchor::kSmoothing_s), 1e-12);
}

}  // namespace
}  // namespace marey::engine
