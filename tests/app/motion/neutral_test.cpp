// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The neutral of motions whose file has no rest that stands.
#include "app/motion/neutral.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "app/motion/read_body.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/neutral_t_pose.h"
#include "retarget/bones/up_of_motion.h"
#include "tests/support/program/paths.h"

namespace marey::app {
namespace {

std::filesystem::path neutral_file(const std::string& name) {
  return marey::testing::shared_data() / name;
}

// Clips of one skeleton, one neutral: bit by bit, and with others behind them.
TEST(Neutral, HasOneNeutralForAllClipsOfASkeleton) {
  std::vector<Motion> clips;
  for (const char* clip : {"walk", "kick", "dance-short"}) {
    const auto file =
        neutral_file("mocap/bandai/dataset-1_" + std::string(clip) + "_normal_001.bvh");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "the files are missing";
    auto raw = read_raw_body(file);
    ASSERT_TRUE(raw);
    clips.push_back(std::move(raw->motion));
    const auto body = read_body(file);
    ASSERT_TRUE(body);
    EXPECT_EQ(body->neutral, NeutralKind::kNamed);
  }
  clips.push_back(clips[0]);
  for (int i = 0; i < 6; ++i) {
    clips[3].poses.insert(
        clips[3].poses.end(), clips[1].poses.begin(), clips[1].poses.end());
  }
  // Named, and by geometry alone.
  for (const auto* named : {retarget::named_neutral("bandai"),
                            static_cast<const retarget::NamedNeutral*>(nullptr)}) {
    std::vector<Motion> motions = clips;
    for (Motion& motion : motions) {
      const auto bones = retarget::identify_bones(motion.skeleton);
      ASSERT_TRUE(bones);
      retarget::set_rest_t_pose(
          motion, *bones, retarget::up_of_motion(motion, *bones).axis, named);
    }
    for (std::size_t i = 0; i < motions[0].skeleton.joints.size(); ++i) {
      const auto turn = [&](std::size_t clip) {
        return motions[clip].skeleton.joints[i].parent_from_joint.rotation;
      };
      EXPECT_EQ(turn(3), turn(0));
      // Lengths of bones have few digits, which differ from file to file.
      for (const std::size_t clip : {1U, 2U}) {
        EXPECT_GT(std::abs(glm::dot(turn(clip), turn(0))), 1.0 - 1e-9);
      }
    }
  }
}

TEST(Neutral, UsesTheRequestedNeutral) {
  const auto file = neutral_file("mocap/bandai/dataset-1_kick_normal_001.bvh");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the file is missing";
  const auto with = [&](const std::string& word) {
    BodyFile body(file);
    const auto neutral = read_neutral(word);
    EXPECT_TRUE(neutral) << neutral.error().message();
    if (neutral) body.neutral = *neutral;
    return read_body(body);
  };
  for (const auto& [word, kind] : std::vector<std::pair<std::string, NeutralKind>>{
           {"auto", NeutralKind::kNamed},
           {"t-pose", NeutralKind::kTPose},
           {"frame:0", NeutralKind::kFrame},
           {"bandai", NeutralKind::kNamed},
           {neutral_file("mocap/bandai/dataset-1_walk_normal_001.bvh").string(),
            NeutralKind::kFile}}) {
    const auto body = with(word);
    ASSERT_TRUE(body) << body.error().message();
    EXPECT_EQ(body->neutral, kind) << word;
  }
  const auto refused = [&](const std::string& word) {
    const auto body = with(word);
    EXPECT_FALSE(body) << word;
    return body ? "" : body.error().message();
  };
  EXPECT_NE(refused("rest").find("the file's rest is not a standing posture"),
            std::string::npos);
  EXPECT_NE(refused("frame:100000").find("there is no frame 100000"), std::string::npos);
  EXPECT_NE(refused(neutral_file("mocap/cmu_bvh_tmoco/rest.bvh").string())
                .find("use a file of the same skeleton"),
            std::string::npos);
  EXPECT_EQ(read_neutral("frame:x").error().cause,
            "\"frame:x\" is not a neutral posture");
  EXPECT_NE(neutral_mistake("nobody").find("bandai"), std::string::npos);
  EXPECT_EQ(neutral_mistake("t-pose"), "");
}

// A remark reports that the rest stands. No remark denies that it is a standing posture.
TEST(Neutral, RemarksOnATPoseThatReplacesARest) {
  const auto file = neutral_file("mocap/cmu_bvh_tmoco/rest.bvh");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the file is missing";
  BodyFile body(file);
  body.neutral = *read_neutral("t-pose");
  const auto read = read_body(body);
  ASSERT_TRUE(read) << read.error().message();
  std::string all;
  for (const std::string& remark : read->remarks()) all += remark + "\n";
  EXPECT_NE(all.find("although the body stands in its rest"), std::string::npos) << all;
  EXPECT_EQ(all.find("its rest is not a standing posture"), std::string::npos) << all;
}

}  // namespace
}  // namespace marey::app
