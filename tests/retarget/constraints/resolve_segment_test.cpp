// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/resolve_segment.h"

#include <optional>

#include <gtest/gtest.h>

#include "core/humanoid.h"

namespace marey::retarget {
namespace {

TEST(ResolveSegment, TakesVrmsBoneBeforeAJointOfThatName) {
  Skeleton skeleton;
  skeleton.joints.resize(3);
  skeleton.joints[0].name = "leftHand";
  skeleton.joints[1].name = "mixamorig:LeftHand";
  skeleton.joints[1].bone = HumanBone::kLeftHand;
  skeleton.joints[2].name = "rightHand";
  EXPECT_EQ(resolve_segment(skeleton, "leftHand"), JointIndex{1});
  EXPECT_EQ(resolve_segment(skeleton, "mixamorig:LeftHand"), JointIndex{1});
  EXPECT_EQ(resolve_segment(skeleton, "rightHand"), JointIndex{2});
  EXPECT_EQ(resolve_segment(skeleton, "head"), std::nullopt);
}

}  // namespace
}  // namespace marey::retarget
