// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/posture_groups.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

EditGroup group_at(std::size_t rotation) {
  return static_cast<EditGroup>(group_of_rotation()[rotation]);
}

TEST(PostureGroups, LimbsBelongToTheirOwnGroup) {
  const std::array<EditGroup, 4> truth{EditGroup::kLeftArm,
                                       EditGroup::kRightArm,
                                       EditGroup::kLeftLeg,
                                       EditGroup::kRightLeg};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(group_of_limb()[i], static_cast<std::uint8_t>(truth[i]));
    EXPECT_EQ(group_at(kLimbRotation + i), truth[i]);
  }
}

TEST(PostureGroups, SegmentsFollowTheirSideAndPart) {
  for (std::size_t i = 0; i < kPostureSegments.size(); ++i) {
    const HumanBone bone = kPostureSegments[i];
    const std::string bone_name{name(bone)};
    const std::string group_name{name(group_at(kSegmentRotation + i))};
    const bool is_sided =
        group_name.starts_with("left_") || group_name.starts_with("right_");
    if (is_sided) {
      EXPECT_EQ(bone_name.starts_with("left"), group_name.starts_with("left"));
    }
  }
  EXPECT_EQ(group_at(kSegmentRotation), EditGroup::kRoot);
  EXPECT_EQ(group_at(kSegmentRotation + 1), EditGroup::kHead);
  EXPECT_EQ(group_at(kSegmentRotation + 3), EditGroup::kTrunk);
  EXPECT_EQ(group_at(kSegmentRotation + 5), EditGroup::kLeftArm);
  EXPECT_EQ(group_at(kSegmentRotation + 10), EditGroup::kRightLeg);
}

TEST(PostureGroups, TheSpineIsTrunkAndTheNeckIsHead) {
  for (std::size_t i = kAbdomenRotation; i < kNeckRotation; ++i) {
    EXPECT_EQ(group_at(i), EditGroup::kTrunk);
  }
  for (std::size_t i = kNeckRotation; i < kUsedRotations; ++i) {
    EXPECT_EQ(group_at(i), EditGroup::kHead);
  }
}

}  // namespace
}  // namespace marey::engine
