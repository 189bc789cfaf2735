// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/smooth_step.h"
#include "core/base/split_mix.h"

namespace marey {
namespace {

SceneGroup made_group(const std::string& id, int count) {
  SceneGroup group;
  group.member.id = id;
  group.member.source = SceneBuild{};
  group.count = count;
  group.columns = count;
  return group;
}

TEST(SplitMix, GivesThePublishedNumbers) {
  SplitMix random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317U);
  EXPECT_EQ(random.next(), 3203168211198807973U);
  EXPECT_EQ(random.next(), 9817491932198370423U);
}

TEST(SplitMix, BelowIsTheUpperHalfOfTheProduct) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SplitMix random(seed);
    SplitMix same(seed);
    const std::uint64_t count = SplitMix(seed + 1).next() >> (seed % 60);
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(same.next()) * (count + 1);
    EXPECT_EQ(random.below(count + 1), static_cast<std::uint64_t>(product >> 64U));
  }
}

TEST(SceneBodies, StaturesOfAGroupAreEvenlySpaced) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Scene scene;
    scene.seed = seed;
    scene.groups.push_back(made_group("g", 1 + static_cast<int>(seed % 50)));
    scene.groups[0].statures_m = {0.6, 2.5};
    std::vector<double> statures_m;
    for (const SceneBody& body : scene_bodies(scene)) {
      statures_m.push_back(std::get<SceneBuild>(body.source).stature_m);
    }
    std::sort(statures_m.begin(), statures_m.end());
    EXPECT_EQ(statures_m.front(), 0.6);
    for (std::size_t k = 1; k < statures_m.size(); ++k) {
      EXPECT_NEAR(statures_m[k] - statures_m[k - 1],
                  1.9 / static_cast<double>(statures_m.size() - 1),
                  1e-12);
    }
  }
}

TEST(SceneBodies, OtherBodiesDoNotChangeAGroup) {
  Scene scene;
  scene.seed = 5;
  scene.groups.push_back(made_group("g", 10));
  scene.groups[0].statures_m = {1.5, 2.0};
  scene.groups[0].build_spread = 0.2;
  const std::vector<SceneBody> before = scene_bodies(scene);
  scene.bodies.push_back({.id = "a"});
  scene.groups.insert(scene.groups.begin(), made_group("f", 3));
  const std::vector<SceneBody> after = scene_bodies(scene);
  ASSERT_EQ(after.size(), 14U);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_EQ(after[k + 4].id, before[k].id);
    EXPECT_EQ(after[k + 4].source, before[k].source);
    const auto& build = std::get<SceneBuild>(before[k].source);
    EXPECT_NEAR(build.arm, 1.0, 0.2);
    EXPECT_NE(build.arm, build.leg);
  }
  scene.seed = 6;
  EXPECT_NE(scene_bodies(scene)[4].source, before[0].source);
}

TEST(SceneBodies, TheGridFollowsTheHeading) {
  Scene scene;
  scene.groups.push_back(made_group("g", 4));
  SceneGroup& group = scene.groups[0];
  group.columns = 2;
  group.spacing_m = {2.0, 1.0};
  group.member.place_xz_m = {10.0, 20.0};
  // Facing +Z: left is +X, behind is -Z.
  std::vector<SceneBody> bodies = scene_bodies(scene);
  EXPECT_EQ(bodies[0].place_xz_m, glm::dvec2(9.0, 20.5));
  EXPECT_EQ(bodies[1].place_xz_m, glm::dvec2(11.0, 20.5));
  EXPECT_EQ(bodies[2].place_xz_m, glm::dvec2(9.0, 19.5));
  // Facing +X: left is -Z, behind is -X.
  group.member.heading_rad = std::numbers::pi / 2.0;
  bodies = scene_bodies(scene);
  EXPECT_NEAR(bodies[0].place_xz_m.x, 10.5, 1e-12);
  EXPECT_NEAR(bodies[0].place_xz_m.y, 21.0, 1e-12);
  EXPECT_NEAR(bodies[3].place_xz_m.x, 9.5, 1e-12);
  EXPECT_NEAR(bodies[3].place_xz_m.y, 19.0, 1e-12);
}

TEST(SceneBodies, NamesFindBodiesGroupsAndMembers) {
  Scene scene;
  scene.bodies.push_back({.id = "a"});
  scene.bodies.push_back({.id = "g.x"});
  scene.groups.push_back(made_group("g", 12));
  const std::vector<SceneBody> bodies = scene_bodies(scene);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const auto found = members_of(scene, bodies[k].id);
    ASSERT_TRUE(found) << bodies[k].id;
    EXPECT_EQ(found->first, k);
    EXPECT_EQ(found->count, 1U);
  }
  EXPECT_EQ(members_of(scene, "g")->count, 12U);
  for (const char* name : {"", "b", "g.", "g.0", "g.13", "g.01", "g.1x", "g.-1", "g1"}) {
    EXPECT_FALSE(members_of(scene, name)) << name;
  }
}

TEST(ScenePath, ALissajousPathIsASineOnEachAxis) {
  const LissajousPath path{{1, 2, 3}, {0.1, 0.2, 0.0}, {0.25, 1, 1}, {0, 0.5, 0}};
  const glm::dvec3 p = *path_at(path, 1.0);
  EXPECT_NEAR(p.x, 1.1, 1e-12);
  EXPECT_NEAR(p.y, 2.0 + 0.2 * std::sin(0.5), 1e-12);
  EXPECT_EQ(p.z, 3.0);
}

TEST(ScenePath, APolylineMeetsItsPoints) {
  PolylinePath path{{1.0, 2.0, 4.0}, {{0, 0, 0}, {1, 0, 0}, {1, 0, 4}}, {}};
  for (const PathCourse course :
       {PathCourse::kLinear, PathCourse::kSmooth, PathCourse::kHold}) {
    path.course = course;
    for (std::size_t k = 0; k < path.times_s.size(); ++k) {
      EXPECT_EQ(*path_at(path, path.times_s[k]), path.positions_m[k]);
    }
    EXPECT_EQ(*path_at(path, -5.0), path.positions_m.front());
    EXPECT_EQ(*path_at(path, 9.0), path.positions_m.back());
    const double z = path_at(path, 2.5)->z;
    EXPECT_NEAR(z,
                course == PathCourse::kLinear   ? 1.0
                : course == PathCourse::kSmooth ? 4.0 * smooth_step(0.25)
                                                : 0.0,
                1e-12);
  }
  EXPECT_FALSE(path_at(BodyPointPath{}, 0.0));
}

}  // namespace
}  // namespace marey
