// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/labels/found_labels.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "library/labels/exchange_sides.h"
#include <gtest/gtest.h>

#include "tests/library/quality/quality_scenes.h"

namespace marey::library {
namespace {

FoundLabels labels_of(const LibraryMotion& clip) {
  const auto map = retarget::map_body(clip.motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return find_labels(clip, *map);
}

std::vector<ClipLabel> with_text(const FoundLabels& found, std::string_view text) {
  std::vector<ClipLabel> out;
  for (const ClipLabel& label : found.labels) {
    if (label.text == text) out.push_back(label);
  }
  return out;
}

std::vector<int> event_frames(const FoundLabels& found, std::string_view name) {
  std::vector<int> out;
  for (const ClipEvent& event : found.events) {
    if (event.name == name) out.push_back(event.frame);
  }
  return out;
}

TEST(FoundLabels, NamesAStandingTPose) {
  const FoundLabels found = labels_of(standing_clip(61, 30.0));
  for (const std::string_view text : {"still", "tpose", "foot_left bears"}) {
    const auto labels = with_text(found, text);
    ASSERT_EQ(labels.size(), 1U) << text;
    EXPECT_EQ(labels[0].start_s, 0.0);
    EXPECT_NEAR(labels[0].end_s, 2.0, 1e-12);
    EXPECT_EQ(labels[0].by, "marey");
  }
  EXPECT_TRUE(with_text(found, "moving").empty());
  // The clip begins and ends in the stance.
  EXPECT_TRUE(found.events.empty());
}

TEST(FoundLabels, NamesStepsOfAWalk) {
  const double hz = 60.0;
  const LibraryMotion walk = walking_clip(static_cast<int>(6.0 * hz), hz);
  const FoundLabels found = labels_of(walk);
  const auto strikes = event_frames(found, "left.strike");
  ASSERT_GE(strikes.size(), 4U);
  for (std::size_t k = 1; k < strikes.size(); ++k) {
    EXPECT_NEAR(strikes[k] - strikes[k - 1], 1.1 * hz, 1.01);
  }
  EXPECT_EQ(with_text(found, "cycle").size(), strikes.size() - 1);
  EXPECT_GE(event_frames(found, "right.strike").size(), 4U);
  EXPECT_GE(event_frames(found, "left.toe_off").size(), 4U);
  EXPECT_TRUE(with_text(found, "still").empty());
  // A strike is the first frame with a contact.
  for (const int frame : strikes) {
    const auto t = static_cast<std::size_t>(frame);
    EXPECT_TRUE(walk.contacts[t][0] != 0 || walk.contacts[t][1] != 0);
    EXPECT_TRUE(walk.contacts[t - 1][0] == 0 && walk.contacts[t - 1][1] == 0);
  }
}

TEST(FoundLabels, NamesFlights) {
  const FoundLabels found = labels_of(jumping_clip(60.0));
  EXPECT_EQ(with_text(found, "flight").size(), 2U);
  const auto off = event_frames(found, "take_off");
  const auto on = event_frames(found, "landing");
  ASSERT_EQ(off.size(), 2U);
  ASSERT_EQ(on.size(), 2U);
  EXPECT_NEAR(off[0], 48, 3);
  EXPECT_NEAR(on[0], 72, 3);
}

TEST(FoundLabels, NamesHandsThatTouch) {
  LibraryMotion clip = standing_clip(120, 60.0);
  const Skeleton& skeleton = clip.motion.skeleton;
  const auto joint = [&](HumanBone bone) { return index(*skeleton.find(bone)); };
  const glm::dvec3 up(0.0, 1.0, 0.0);
  // Both arms forward for a second in the middle, palms together.
  for (std::size_t t = 30; t < 90; ++t) {
    Pose& pose = clip.motion.poses[t];
    pose.parent_from_joint[joint(HumanBone::kLeftUpperArm)] = glm::angleAxis(-1.87, up);
    pose.parent_from_joint[joint(HumanBone::kRightUpperArm)] = glm::angleAxis(1.87, up);
  }
  const FoundLabels found = labels_of(clip);
  const auto touches = with_text(found, "hand_left touches right hand");
  ASSERT_EQ(touches.size(), 1U);
  EXPECT_NEAR(touches[0].start_s, 0.5, 0.1);
  EXPECT_NEAR(touches[0].end_s, 1.5, 0.1);
  EXPECT_EQ(event_frames(found, "left.touch").size(), 1U);
  EXPECT_EQ(event_frames(found, "left.release").size(), 1U);
}

TEST(FoundLabels, AreOrderedBoundedAndCanBeMirrored) {
  LibraryMotion clip = walking_clip(600, 30.0);
  // Contacts that change all the time.
  for (std::size_t t = 0; t < clip.contacts.size(); ++t) {
    const bool bears = t / 4 % 2 == 0;
    clip.contacts[t] = bears ? FootParts{1, 1, 0, 0} : FootParts{0, 0, 1, 1};
  }
  const FoundLabels found = labels_of(clip);
  std::map<std::string, int> counts;
  for (std::size_t k = 0; k < found.labels.size(); ++k) {
    const ClipLabel& label = found.labels[k];
    ++counts[label.text];
    EXPECT_GE(label.end_s - label.start_s, 0.1 - 1e-9);
    EXPECT_TRUE(exchanged_sides(label.text)) << label.text;
    if (k > 0) {
      EXPECT_LE(found.labels[k - 1].start_s, label.start_s);
    }
  }
  for (const auto& [text, count] : counts) EXPECT_LE(count, 30) << text;
  EXPECT_TRUE(std::is_sorted(
      found.events.begin(), found.events.end(), [](const auto& a, const auto& b) {
        return a.frame < b.frame;
      }));
  for (const ClipEvent& event : found.events) {
    EXPECT_TRUE(exchanged_sides(event.name)) << event.name;
  }
}

}  // namespace
}  // namespace marey::library
