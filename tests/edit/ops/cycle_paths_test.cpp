// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/cycle_paths.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::edit {
namespace {

constexpr glm::dvec3 kAnywhere(0.3, 1.0, -0.7);

TEST(CycleScrew, IsTheTravelAtOneAndComposes) {
  testing::Dice dice(21);
  for (int n = 0; n < 40; ++n) {
    const double turn = n % 4 == 0 ? dice.noise(1e-5) : dice.between(-3.0, 3.0);
    const PlanarMove travel{turn, {dice.noise(3.0), dice.noise(3.0)}};
    const CycleScrew screw(travel);
    EXPECT_LT(glm::distance(screw.at(1.0)(kAnywhere), travel(kAnywhere)), 1e-12);
    const PlanarMove both = screw.at(0.37) * screw.at(0.9);
    EXPECT_LT(glm::distance(both(kAnywhere), screw.at(1.27)(kAnywhere)), 1e-11);
  }
}

TEST(CyclePaths, AreAsLongAsEachOtherAndAgreeInTheMiddle) {
  // A quarter of a circle of radius 2 m about the origin.
  const PlanarMove travel{1.5707963267948966, {0.0, 0.0}};
  const glm::dvec3 centre(2.0, 0.0, 0.0);
  const CyclePaths paths(travel, CycleDrift::kStraight, centre);
  EXPECT_EQ(paths.step().turn_rad, 0.0);
  EXPECT_NEAR(glm::length(paths.step().shift_xz_m), 2.0 * 1.5707963267948966, 1e-12);
  EXPECT_LT(glm::distance(paths.new_path(0.5)(centre), paths.old_path(0.5)(centre)),
            1e-12);
  const glm::dvec3 way = travel(centre) - centre;
  EXPECT_GT(
      glm::dot(glm::dvec3(paths.step().shift_xz_m.x, 0.0, paths.step().shift_xz_m.y),
               way),
      0.0);
}

TEST(CyclePaths, KeepTheTravelIfAsked) {
  const PlanarMove travel{0.4, {1.0, 2.0}};
  const CyclePaths paths(travel, CycleDrift::kKeep, {0.0, 0.0, 0.0});
  EXPECT_LT(glm::distance(paths.step()(kAnywhere), travel(kAnywhere)), 1e-12);
  EXPECT_LT(glm::distance(paths.in_place(0.6)(paths.new_path(0.6)(kAnywhere)),
                          paths.new_path(0.0)(kAnywhere)),
            1e-12);
}

}  // namespace
}  // namespace marey::edit
