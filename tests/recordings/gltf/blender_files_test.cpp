// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Compares files written by Blender with Blender's own joint positions.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/csv_line.h"
#include "recordings/gltf/gltf.h"
#include "recordings/motion/bvh.h"
#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

const std::filesystem::path kData = marey::testing::source_dir() / "tests/data";

struct KnownPlace {
  std::size_t frame = 0;
  std::string joint;
  glm::dvec3 p_in_world{0.0};
};

std::vector<KnownPlace> known_places() {
  const Result<std::string> text = read_file(kData / "blender_arm.csv");
  EXPECT_TRUE(text);
  std::vector<KnownPlace> places;
  if (!text) return places;
  CsvLines lines(*text);
  (void)lines.next();  // The names of the columns.
  while (const auto line = lines.next()) {
    CsvFields fields(*line);
    KnownPlace place;
    place.frame = fields.number<std::size_t>();
    place.joint = fields.text();
    for (int i = 0; i < 3; ++i) place.p_in_world[i] = fields.number<double>();
    EXPECT_TRUE(fields.good() && fields.ended()) << *line;
    places.push_back(place);
  }
  EXPECT_EQ(places.size(), 15U);
  return places;
}

/// Returns the largest distance of a joint to its position in Blender. [m]
template <class FromFile>
double largest_error_m(const Motion& motion, const FromFile& world_from_file) {
  double largest_m = 0.0;
  for (const KnownPlace& place : known_places()) {
    const auto joint = motion.skeleton.find(place.joint);
    EXPECT_TRUE(joint) << place.joint;
    if (!joint || place.frame >= motion.poses.size()) return 1e9;
    const auto joints = world_from_joints(motion.skeleton, motion.poses[place.frame]);
    largest_m = std::max(largest_m,
                         glm::distance(world_from_file(joints[index(*joint)].translation),
                                       place.p_in_world));
  }
  return largest_m;
}

// Six decimals of a metre and of a degree.
TEST(BlenderFiles, TheBvhHasItsJointsWhereBlenderHasThem) {
  const auto read = read_bvh(kData / "blender_arm.bvh", {.unit_m = 1.0});
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->motion.skeleton.joints.size(), 3U);
  EXPECT_EQ(read->motion.poses.size(), 5U);
  EXPECT_EQ(read->motion.rate.hz, 25.0);
  EXPECT_LT(read->ignored_translation_m, 1e-6);
  const auto z_up = [](const glm::dvec3& p) { return glm::dvec3(p.x, p.z, -p.y); };
  EXPECT_LT(largest_error_m(read->motion, z_up), 2e-6 /* m */);
}

// Floats: the error of a metre is a ten thousandth of a millimetre.
TEST(BlenderFiles, TheGlbHasItsJointsWhereBlenderHasThem) {
  const auto read = read_character(kData / "blender_arm.glb");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(read->motion);
  EXPECT_EQ(read->motion->rate.hz, 25.0);
  EXPECT_EQ(read->motion->poses.size(), 5U);
  EXPECT_LT(read->ignored_translation_m, 1e-6);
  const auto same = [](const glm::dvec3& p) { return p; };
  EXPECT_LT(largest_error_m(*read->motion, same), 2e-6 /* m */);
}

TEST(BlenderFiles, TheSkinLiesRoundTheRestingArm) {
  const auto read = read_character(kData / "blender_arm.glb");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(read->mesh);
  ASSERT_FALSE(read->mesh->p_in_world.empty());
  for (const glm::dvec3& p : read->mesh->p_in_world) {
    // Rings of 3 cm at the four joints, at a height of 1.4 m.
    EXPECT_NEAR(std::abs(p.y - 1.4), 0.03, 1e-6);
    EXPECT_NEAR(std::abs(p.z), 0.03, 1e-6);
    EXPECT_TRUE(std::ranges::any_of(std::vector{0.2, 0.5, 0.75, 0.85}, [&](double x) {
      return std::abs(p.x - x) < 1e-6;
    })) << p.x;
  }
}

}  // namespace
}  // namespace marey::recordings
