// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/relations.h"

#include <algorithm>
#include <functional>
#include <numbers>
#include <set>
#include <string>

#include "library/search/relation_measures.h"
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/library/moved_motion.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::library {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRate_hz = 30.0;

std::vector<RelationRun> relations_of(const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return find_relations(motion, *map, retarget::detect_contacts(motion, *map));
}

std::vector<FrameRange> runs_of(const std::vector<RelationRun>& runs, Relation word) {
  std::vector<FrameRange> out;
  for (const RelationRun& run : runs) {
    if (run.relation == word) out.push_back(run.frames);
  }
  return out;
}

bool holds_at(const std::vector<RelationRun>& runs, Relation word, int frame) {
  const auto found = runs_of(runs, word);
  return std::any_of(found.begin(), found.end(), [&](const FrameRange& r) {
    return r.first <= frame && frame <= r.last;
  });
}

// A standing adult, arms down, changed by a function of the frame.
Motion standing_motion(int frames, const std::function<void(int, Pose&)>& change) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  Motion motion{body, FrameRate{kRate_hz}, 0, {}};
  for (int n = 0; n < frames; ++n) {
    Pose pose = rest_pose(body);
    const glm::dvec3 z(0.0, 0.0, 1.0);
    pose.parent_from_joint[index(HumanBone::kLeftUpperArm)] = glm::angleAxis(-1.4, z);
    pose.parent_from_joint[index(HumanBone::kRightUpperArm)] = glm::angleAxis(1.4, z);
    change(n, pose);
    motion.poses.push_back(pose);
  }
  return motion;
}

TEST(Relations, HaveWordsAndMirrorImages) {
  std::set<std::string> words;
  for (int k = 0; k < kRelationCount; ++k) {
    const auto word = static_cast<Relation>(k);
    words.emplace(name(word));
    EXPECT_EQ(relation(name(word)), word);
    EXPECT_EQ(mirrored(mirrored(word)), word);
    std::string other(name(word));
    const std::size_t left = other.find("left");
    const std::size_t right = other.find("right");
    if (left != std::string::npos) other.replace(left, 4, "right");
    if (right != std::string::npos) other.replace(right, 5, "left");
    EXPECT_EQ(name(mirrored(word)), other);
  }
  EXPECT_EQ(words.size(), 23U);
  EXPECT_FALSE(relation("hand_left").has_value());
  EXPECT_FALSE(relation("").has_value());
}

TEST(Relations, NameBothFeetOfAStandingBody) {
  const auto runs = relations_of(standing_motion(60, [](int, Pose&) {}));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].relation, Relation::kLeftFootBears);
  EXPECT_EQ(runs[1].relation, Relation::kRightFootBears);
  for (const RelationRun& run : runs) {
    EXPECT_EQ(run.frames.first, 0);
    EXPECT_EQ(run.frames.last, 59);
  }
}

// The left arm goes up sideways and down again.
TEST(Relations, NameTheRaisedHandOnly) {
  const auto runs = relations_of(standing_motion(90, [](int n, Pose& pose) {
    const double up = -1.4 + 2.9 * std::sin(kPi * n / 89.0);
    pose.parent_from_joint[index(HumanBone::kLeftUpperArm)] =
        glm::angleAxis(up, glm::dvec3(0.0, 0.0, 1.0));
  }));
  for (const Relation word : {Relation::kLeftHandAboveHead,
                              Relation::kLeftHandAboveShoulder,
                              Relation::kLeftHandRaised}) {
    ASSERT_EQ(runs_of(runs, word).size(), 1U);
    EXPECT_TRUE(holds_at(runs, word, 45));
    EXPECT_FALSE(holds_at(runs, word, 0));
    EXPECT_FALSE(holds_at(runs, word, 89));
    EXPECT_TRUE(runs_of(runs, mirrored(word)).empty());
  }
  EXPECT_LT(runs_of(runs, Relation::kLeftHandAboveShoulder)[0].first,
            runs_of(runs, Relation::kLeftHandAboveHead)[0].first);
}

// The height of the hand wavers between both levels, after it was above the first once.
TEST(Relations, LastAboveTheSecondLevelAndBeginAtTheFirst) {
  // Elevation of the arm, so that the hand is 0.02 and 0.08 L over the
  // shoulder.
  const double between = std::asin(0.02 * 0.85 / 0.55);
  const double over = std::asin(0.10 * 0.85 / 0.50);
  const Motion motion = standing_motion(60, [&](int n, Pose& pose) {
    double up = -0.3;
    if (n >= 10) up = between;
    if (n >= 20) up = n % 2 == 0 ? over : between;
    if (n >= 40) up = -0.1;
    pose.parent_from_joint[index(HumanBone::kLeftUpperArm)] =
        glm::angleAxis(up, glm::dvec3(0.0, 0.0, 1.0));
  });
  const auto map = retarget::map_body(motion.skeleton);
  const auto contacts = retarget::detect_contacts(motion, *map);
  const auto measures = measure_relations(motion, *map, contacts);
  ASSERT_GT(*measures[15].sides[0].hand_over_shoulder, 0.0);
  ASSERT_LT(*measures[15].sides[0].hand_over_shoulder, 0.05);
  ASSERT_GT(*measures[20].sides[0].hand_over_shoulder, 0.05);
  ASSERT_LT(*measures[45].sides[0].hand_over_shoulder, 0.0);
  const auto runs =
      runs_of(find_relations(motion, *map, contacts), Relation::kLeftHandAboveShoulder);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].first, 20);
  EXPECT_EQ(runs[0].last, 39);
}

TEST(Relations, NameHandsBeforeTheBodyAndTogether) {
  const auto runs = relations_of(standing_motion(30, [](int, Pose& pose) {
    const glm::dvec3 y(0.0, 1.0, 0.0);
    // From the T-pose forward, and inward until the hands meet.
    pose.parent_from_joint[index(HumanBone::kLeftUpperArm)] = glm::angleAxis(-1.8, y);
    pose.parent_from_joint[index(HumanBone::kRightUpperArm)] = glm::angleAxis(1.8, y);
  }));
  EXPECT_TRUE(holds_at(runs, Relation::kLeftHandBeforeBody, 15));
  EXPECT_TRUE(holds_at(runs, Relation::kRightHandBeforeBody, 15));
  EXPECT_TRUE(holds_at(runs, Relation::kHandsTogether, 15));
  EXPECT_FALSE(holds_at(runs, Relation::kLeftHandBehindBody, 15));
}

TEST(Relations, NameTheSideOfATurn) {
  for (const double rate_deg : {15.0, 60.0, -60.0}) {
    const auto runs = relations_of(standing_motion(90, [&](int n, Pose& pose) {
      pose.parent_from_joint[0] = glm::angleAxis(rate_deg * kPi / 180.0 * n / kRate_hz,
                                                 glm::dvec3(0.0, 1.0, 0.0));
    }));
    EXPECT_EQ(holds_at(runs, Relation::kTurningLeft, 45), rate_deg > 30.0);
    EXPECT_EQ(holds_at(runs, Relation::kTurningRight, 45), rate_deg < -30.0);
    EXPECT_FALSE(holds_at(runs, Relation::kMoving, 45));
  }
}

TEST(Relations, ExcludeCrouchingWhileLying) {
  const auto runs = relations_of(standing_motion(60, [](int, Pose& pose) {
    pose.root_in_world = {0.0, 0.15, 0.0};
    pose.parent_from_joint[0] = glm::angleAxis(-kPi / 2.0, glm::dvec3(1.0, 0.0, 0.0));
  }));
  EXPECT_TRUE(holds_at(runs, Relation::kLying, 30));
  EXPECT_FALSE(holds_at(runs, Relation::kCrouched, 30));
  EXPECT_FALSE(holds_at(runs, Relation::kFlight, 30));
}

// Thighs forward and shanks back, hips lowered by as much.
TEST(Relations, NameACrouchAndBentKnees) {
  const auto runs = relations_of(standing_motion(60, [](int, Pose& pose) {
    const glm::dvec3 x(1.0, 0.0, 0.0);
    for (const HumanBone leg : {HumanBone::kLeftUpperLeg, HumanBone::kRightUpperLeg}) {
      pose.parent_from_joint[index(leg)] = glm::angleAxis(-1.4, x);
    }
    for (const HumanBone shank : {HumanBone::kLeftLowerLeg, HumanBone::kRightLowerLeg}) {
      pose.parent_from_joint[index(shank)] = glm::angleAxis(2.2, x);
    }
    pose.root_in_world.y = 0.5;
  }));
  EXPECT_TRUE(holds_at(runs, Relation::kCrouched, 30));
  EXPECT_TRUE(holds_at(runs, Relation::kLeftKneeBent, 30));
  EXPECT_TRUE(holds_at(runs, Relation::kRightKneeBent, 30));
  EXPECT_FALSE(holds_at(runs, Relation::kLying, 30));
}

// Stands, is in the air for half a second, and stands.
TEST(Relations, FindTheFlightOfAJump) {
  const auto runs = relations_of(standing_motion(90, [](int n, Pose& pose) {
    const double t = (n - 40) / kRate_hz;
    pose.root_in_world.y += std::max(0.0, 2.45 * t - 0.5 * 9.81 * t * t);
  }));
  const auto flights = runs_of(runs, Relation::kFlight);
  ASSERT_EQ(flights.size(), 1U);
  EXPECT_NEAR(flights[0].first, 41, 1);
  EXPECT_NEAR(flights[0].last, 54, 1);
}

TEST(Relations, AlternateInAWalk) {
  const Motion motion = testing::synthetic_walk(200, 60.0).motion;
  const auto runs = relations_of(motion);
  EXPECT_TRUE(holds_at(runs, Relation::kMoving, 100));
  EXPECT_GE(runs_of(runs, Relation::kLeftInFront).size(), 2U);
  EXPECT_GE(runs_of(runs, Relation::kRightInFront).size(), 2U);
  for (int frame = 0; frame < 200; ++frame) {
    EXPECT_FALSE(holds_at(runs, Relation::kLeftInFront, frame) &&
                 holds_at(runs, Relation::kRightInFront, frame));
  }
  EXPECT_TRUE(std::is_sorted(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
    return a.frames.first < b.frames.first;
  }));
}

std::multiset<std::string> words_and_frames(const std::vector<RelationRun>& runs,
                                            bool is_mirrored) {
  std::multiset<std::string> out;
  for (const RelationRun& run : runs) {
    const Relation word = is_mirrored ? mirrored(run.relation) : run.relation;
    out.insert(std::string(name(word)) + " " + std::to_string(run.frames.first) + " " +
               std::to_string(run.frames.last));
  }
  return out;
}

TEST(Relations, AreMirroredWithTheMotion) {
  const Motion motion = random_motion(12, 300, 30.0);
  const auto runs = relations_of(motion);
  ASSERT_GT(runs.size(), 10U);
  EXPECT_EQ(words_and_frames(runs, true),
            words_and_frames(relations_of(reflected(motion)), false));
}

TEST(Relations, DoNotDependOnThePlaceOnTheFloorOrTheSize) {
  const Motion motion = random_motion(13, 300, 30.0);
  const auto truth = words_and_frames(relations_of(motion), false);
  EXPECT_EQ(truth, words_and_frames(relations_of(moved(motion, 1.2, 3.0, -4.0)), false));
  EXPECT_EQ(truth, words_and_frames(relations_of(scaled(motion, 0.5)), false));
}

TEST(Relations, NeverNameAHandWithoutArms) {
  Motion motion = random_motion(14, 120, 30.0);
  for (Joint& joint : motion.skeleton.joints) {
    if (joint.bone && name(*joint.bone).find("Arm") != std::string_view::npos) {
      joint.bone.reset();
    }
  }
  for (const RelationRun& run : relations_of(motion)) {
    EXPECT_EQ(name(run.relation).find("hand"), std::string_view::npos);
  }
  motion.poses.resize(1);
  for (const RelationRun& run : relations_of(motion)) {
    EXPECT_NE(run.relation, Relation::kMoving);
    EXPECT_EQ(run.frames.last, 0);
  }
  motion.poses.clear();
  EXPECT_TRUE(relations_of(motion).empty());
}

}  // namespace
}  // namespace marey::library
