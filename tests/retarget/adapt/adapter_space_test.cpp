// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Allowed and forbidden boxes of points.
namespace marey::retarget {
namespace {

constexpr std::array<const char*, 7> kSegments{
    "leftHand", "rightHand", "leftFoot", "head", "leftLowerArm", "chest", "hips"};

BodyPoint any_point(Dice& dice) {
  const auto& segment = kSegments[static_cast<std::size_t>(dice.between(0, 6.999))];
  return {segment, dice.between(0, 1) < 0.5 ? glm::dvec3(0.0) : 0.1 * dice.direction()};
}

glm::dvec3 any_size(Dice& dice, double max_m) {
  return {
      dice.between(0.02, max_m), dice.between(0.02, max_m), dice.between(0.02, max_m)};
}

Constraint wish_of(const BodyPoint& point, const Goal& goal) {
  Constraint wish;
  wish.id = "wish";
  wish.point = point;
  wish.goal = goal;
  return wish;
}

class AdapterSpace : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterSpace, both_methods(), name_of);

// The body is free to move, so every box can be reached.
TEST_P(AdapterSpace, KeepsPointsInAllowedBoxes) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    Dice dice(31);
    for (int i = 0; i < 300; ++i) {
      const Pose reference = random_posture(body, dice, 0.3);
      const BodyPoint point = any_point(dice);
      const glm::dvec3 centre =
          place_of(body, reference, point) + dice.between(0, 0.5) * dice.direction();
      const glm::dvec3 half = 0.5 * any_size(dice, 0.3);
      const Constraint wish = wish_of(point, AllowedSpace{centre - half, centre + half});
      const Adapted out = adapted(body, {{wish}, {}}, reference, options());
      const glm::dvec3 p = place_of(body, out.pose, point);
      ASSERT_LT(glm::distance(p, glm::clamp(p, centre - half, centre + half)),
                wish.precision_m + 1e-6)
          << i << " " << point.segment;
    }
  }
}

TEST_P(AdapterSpace, KeepsPointsOutOfForbiddenBoxes) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    Dice dice(32);
    for (int i = 0; i < 300; ++i) {
      const Pose reference = random_posture(body, dice, 0.3);
      const BodyPoint point = any_point(dice);
      const glm::dvec3 half = any_size(dice, 0.3);
      const glm::dvec3 centre =
          place_of(body, reference, point) +
          0.7 * half *
              glm::dvec3(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1));
      const Constraint wish =
          wish_of(point, ForbiddenSpace{centre - half, centre + half});
      const Adapted out = adapted(body, {{wish}, {}}, reference, options());
      const glm::dvec3 p = place_of(body, out.pose, point);
      const glm::dvec3 depth = glm::min(p - (centre - half), (centre + half) - p);
      ASSERT_LT(std::min({depth.x, depth.y, depth.z}), wish.precision_m + 1e-6)
          << i << " " << point.segment;
    }
  }
}

TEST_P(AdapterSpace, LeavesPointsThatAreWhereTheyMayBe) {
  const Character body = human(true);
  Dice dice(33);
  for (int i = 0; i < 100; ++i) {
    const Pose reference = random_posture(body, dice, 0.3);
    const BodyPoint point = any_point(dice);
    const glm::dvec3 half = any_size(dice, 0.3);
    const glm::dvec3 centre = place_of(body, reference, point) + 0.9 * half;
    Constraint in = wish_of(point, AllowedSpace{centre - half, centre + half});
    Constraint out_of = wish_of(
        point, ForbiddenSpace{centre - half + 2.0 * half, centre + half + 2.0 * half});
    out_of.id = "out of";
    const Adapted out = adapted(body, {{in, out_of}, {}}, reference, options());
    ASSERT_LT(furthest_m(body, out.pose, reference), 5e-6) << i << " " << point.segment;
  }
}

}  // namespace
}  // namespace marey::retarget
