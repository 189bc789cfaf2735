// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/acclaim.h"

#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::testing {
namespace {

// A hip, a thigh whose axes are turned by a quarter about Z, and a shank.
const std::string kSkeleton = R"(# of our own
:version 1.10
:name TINY
:units
  mass 1.0
  length 0.254
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name hip
     direction 1 0 0
     length 2
     axis 0 0 0 XYZ
  end
  begin
     id 2
     name thigh
     direction 0 -3 0
     length 4
     axis 0 0 90 XYZ
    dof rx rz
    limits (-160.0 20.0)
           (-70.0 70.0)
  end
  begin
     id 3
     name shank
     direction 0 -1 0
     length 3
     axis 0 0 0 XYZ
    dof rx
    limits (-10.0 170.0)
  end
:hierarchy
  begin
    root hip
    hip thigh
    thigh shank
  end
)";

AcclaimSkeleton skeleton() {
  auto read = parse_asf(kSkeleton, "tiny.asf");
  EXPECT_TRUE(read) << read.error().message();
  return *std::move(read);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

// A length of 1 is 1 / 0.254 of an inch: lengths are in decimetres.
TEST(Acclaim, BonesAreChainedWithTheirLengthsInMetres) {
  const auto s = skeleton();
  ASSERT_EQ(s.bones.size(), 4U);
  EXPECT_DOUBLE_EQ(s.unit_m, 0.1);
  const auto frames = parse_amc(s, ":DEGREES\n1\nroot 10 20 30 0 0 0\n", "a.amc");
  ASSERT_TRUE(frames);
  const auto bones = file_from_bones(s, frames->at(0));
  expect_near(bones[*s.find("hip")].translation, {1.0, 2.0, 3.0});
  expect_near(bones[*s.find("thigh")].translation, {1.2, 2.0, 3.0});
  expect_near(bones[*s.find("shank")].translation, {1.2, 1.6, 3.0});
}

// Computed by hand: the thigh's own X is the root's Y, so a thigh that points down does
// not move about it; its Z is the root's. Rotated by 90 degrees about Z it points along
// X, and the shank, bent by 90 about X there, along its parent's former -Z.
TEST(Acclaim, BonesTurnAboutTheirOwnAxes) {
  const auto s = skeleton();
  const auto frames = parse_amc(
      s,
      "1\nroot 0 0 0 0 0 0\nthigh 30 0\n2\nroot 0 0 0 0 0 0\nthigh 0 90\nshank 90\n",
      "a");
  ASSERT_TRUE(frames);
  expect_near(file_from_bones(s, frames->at(0))[3].translation, {0.2, -0.4, 0.0});
  const auto bones = file_from_bones(s, frames->at(1));
  expect_near(bones[3].translation, {0.6, 0.0, 0.0});
  expect_near(bones[3] * s.bones[3].span_in_root, {0.6, 0.0, -0.3});
}

// The root rotates about the fixed axes X, then Y, then Z: (0, 0, 1) goes to (0, -1, 0),
// stays there, and goes to (1, 0, 0).
TEST(Acclaim, AnglesTurnAboutXThenYThenZ) {
  const auto s = skeleton();
  const auto frames = parse_amc(s, "1\nroot 0 0 0 90 90 90\n", "a.amc");
  ASSERT_TRUE(frames);
  expect_near(file_from_bones(s, frames->at(0))[0].rotation * glm::dvec3(0, 0, 1),
              {1.0, 0.0, 0.0});
}

TEST(Acclaim, ABrokenFileIsRefusedWithItsLine) {
  const auto s = skeleton();
  const auto short_row = parse_amc(s, "1\nthigh 30\n", "a.amc");
  ASSERT_FALSE(short_row);
  EXPECT_EQ(short_row.error().message(),
            "a.amc:2: thigh has 1 numbers, not 2. Next: check the file.");
  const auto nothing = parse_asf("BVH", "a.asf");
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().message(),
            "a.asf:1: no bones, or no unit of length. Next: check the file.");
}

}  // namespace
}  // namespace marey::testing
