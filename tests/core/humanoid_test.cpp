// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/humanoid.h"

#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey {
namespace {

TEST(HumanBones, AreListedInTheOrderOfTheirNumbers) {
  for (std::size_t i = 0; i < human_bones().size(); ++i) {
    EXPECT_EQ(index(human_bones()[i]), i);
  }
}

TEST(HumanBones, ComeAfterTheirParents) {
  for (const HumanBone bone : human_bones()) {
    const auto above = parent(bone);
    EXPECT_EQ(above.has_value(), bone != HumanBone::kHips);
    if (above) {
      EXPECT_LT(*above, bone) << name(bone);
    }
  }
}

TEST(HumanBones, AreFoundByTheirNames) {
  std::set<std::string_view> names;
  for (const HumanBone bone : human_bones()) {
    EXPECT_EQ(human_bone(name(bone)), bone);
    names.insert(name(bone));
  }
  EXPECT_EQ(names.size(), human_bones().size());
}

TEST(HumanBones, AreNotFoundByOtherNames) {
  for (const char* other : {"", "Hips", "leftupperarm", "leftThumbProximal", "jaw"}) {
    EXPECT_FALSE(human_bone(other)) << other;
  }
}

TEST(Mirrored, IsItsOwnInverse) {
  for (const HumanBone bone : human_bones()) EXPECT_EQ(mirrored(mirrored(bone)), bone);
}

TEST(Mirrored, ExchangesLeftAndRightInTheNames) {
  for (const HumanBone bone : human_bones()) {
    std::string expected(name(bone));
    if (expected.starts_with("left")) {
      expected = "right" + expected.substr(4);
    } else if (expected.starts_with("right")) {
      expected = "left" + expected.substr(5);
    }
    EXPECT_EQ(name(mirrored(bone)), expected);
  }
}

TEST(Mirrored, KeepsFamiliesTogether) {
  for (const HumanBone bone : human_bones()) {
    const auto above = parent(bone);
    if (above) {
      EXPECT_EQ(parent(mirrored(bone)), mirrored(*above)) << name(bone);
    }
  }
}

TEST(HumanLimbs, AreChainsOfThreeBones) {
  for (const HumanLimb& limb : human_limbs()) {
    EXPECT_EQ(parent(limb.lower), limb.upper);
    EXPECT_EQ(parent(limb.end), limb.lower);
  }
}

TEST(HumanLimbs, BendTheNaturalWayForAPositiveAngle) {
  const Proportions p = average_proportions(1.75);
  for (const HumanLimb& limb : human_limbs()) {
    EXPECT_NEAR(glm::dot(limb.hinge_axis, p[limb.lower]), 0.0, 1e-15);
    const glm::dvec3 bent =
        rotation_from_vector(glm::radians(90.0) * limb.hinge_axis) * p[limb.end];
    const bool is_arm =
        limb.end == HumanBone::kLeftHand || limb.end == HumanBone::kRightHand;
    // Forearms fold forward, shanks backward.
    const glm::dvec3 expected(0.0, 0.0, is_arm ? 1.0 : -1.0);
    EXPECT_LT(glm::distance(glm::normalize(bent), expected), 1e-12) << name(limb.end);
  }
}

}  // namespace
}  // namespace marey
