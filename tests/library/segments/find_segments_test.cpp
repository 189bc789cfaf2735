// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/segments/find_segments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "library/clips/normal_form.h"
#include "library/segments/novelty.h"
#include <gtest/gtest.h>

#include "tests/library/moved_motion.h"
#include "tests/library/quality/quality_scenes.h"

namespace marey::library {
namespace {

std::vector<FrameRange> segments(const LibraryMotion& clip,
                                 SegmentBy by,
                                 const std::vector<ClipLabel>& labels = {}) {
  const auto map = retarget::map_body(clip.motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return find_segments(clip, *map, by, labels);
}

LibraryMotion clip_of_motion(Motion motion) {
  LibraryMotion clip;
  clip.contacts.assign(motion.poses.size(), FootParts{});
  clip.motion = std::move(motion);
  return clip;
}

void expect_ranges(const std::vector<FrameRange>& found,
                   const std::vector<FrameRange>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].first, expected[k].first);
    EXPECT_EQ(found[k].last, expected[k].last);
  }
}

void expect_partition(const std::vector<FrameRange>& ranges, int count) {
  int next = 0;
  for (const FrameRange& range : ranges) {
    EXPECT_EQ(range.first, next);
    EXPECT_GE(range.last, range.first);
    next = range.last + 1;
  }
  EXPECT_EQ(next, count);
}

TEST(FindSegments, IsTheWholeMotionByDefault) {
  expect_ranges(segments(walking_clip(90, 30.0), SegmentBy::kNone), {{0, 89}});
}

TEST(FindSegments, FollowsLabelsOfPeople) {
  const std::vector<ClipLabel> labels{{1.0, 2.0, "walk", "ann", 1.0},
                                      {0.5, 1.5, "turn", "table", 1.0},
                                      {1.0, 2.0, "slow", "ann", 1.0},
                                      {0.2, 2.8, "moving", "marey", 1.0},
                                      {2.5, 9.0, "end", "ann", 1.0},
                                      {2.0, 2.0, "instant", "ann", 1.0},
                                      {5.0, 6.0, "beyond", "ann", 1.0}};
  expect_ranges(segments(walking_clip(90, 30.0), SegmentBy::kLabels, labels),
                {{15, 45}, {30, 60}, {75, 89}});
  EXPECT_TRUE(segments(walking_clip(90, 30.0), SegmentBy::kLabels).empty());
}

TEST(FindSegments, DividesAtStillness) {
  const double hz = 60.0;
  const Motion walk = walking_clip(120, hz).motion;
  Motion motion = walk;
  const auto hold = [&](int frames) {
    motion.poses.insert(
        motion.poses.end(), static_cast<std::size_t>(frames), motion.poses.back());
  };
  hold(90);
  // The way back, so that no pose jumps.
  motion.poses.insert(motion.poses.end(), walk.poses.rbegin(), walk.poses.rend());
  hold(60);
  const auto found = segments(clip_of_motion(motion), SegmentBy::kStillness);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].first, 0);
  EXPECT_NEAR(found[0].last, 120 + 15, 7);
  EXPECT_NEAR(found[1].first, 210 - 15, 7);
  EXPECT_NEAR(found[1].last, 330 + 15, 7);
  EXPECT_TRUE(segments(standing_clip(100, 30.0), SegmentBy::kStillness).empty());
  expect_ranges(segments(walking_clip(90, 30.0), SegmentBy::kStillness), {{0, 89}});
}

// The synthetic walk has a left strike every 1.1 s.
TEST(FindSegments, DividesAWalkIntoCycles) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    const auto found =
        segments(walking_clip(static_cast<int>(6.0 * hz), hz), SegmentBy::kSteps);
    ASSERT_GE(found.size(), 3U);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR((found[k].last - found[k].first + 1) / hz, 1.1, 1.5 / hz);
      if (k > 0) {
        EXPECT_EQ(found[k].first, found[k - 1].last + 1);
      }
    }
  }
  EXPECT_TRUE(segments(standing_clip(90, 30.0), SegmentBy::kSteps).empty());
}

TEST(FindSegments, ACycleNeedsTheOtherFoot) {
  std::vector<FootParts> contacts(100);
  for (const int first : {10, 40, 70}) {
    for (int t = first; t < first + 10; ++t) contacts[static_cast<std::size_t>(t)][1] = 1;
  }
  EXPECT_TRUE(find_cycles(contacts, 30.0).empty());
  for (int t = 55; t < 60; ++t) contacts[static_cast<std::size_t>(t)][2] = 1;
  expect_ranges(find_cycles(contacts, 30.0), {{40, 69}});
}

// A body that moves, and after a time moves in another way.
Motion changing_motion(double hz, const std::vector<double>& changes_s, double end_s) {
  Motion motion = standing_clip(static_cast<int>(end_s * hz), hz).motion;
  const std::size_t left = index(*motion.skeleton.find(HumanBone::kLeftUpperArm));
  const std::size_t right = index(*motion.skeleton.find(HumanBone::kRightUpperArm));
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const double time_s = static_cast<double>(t) / hz;
    const auto part = std::count_if(changes_s.begin(),
                                    changes_s.end(),
                                    [&](double change_s) { return change_s <= time_s; });
    const double angle = 0.3 * std::sin(9.0 * time_s);
    motion.poses[t].parent_from_joint[part % 2 == 0 ? left : right] =
        glm::angleAxis(angle + (part % 2 == 0 ? -1.0 : 1.0), glm::dvec3(0.0, 0.0, 1.0));
  }
  return motion;
}

TEST(FindSegments, DividesAtChangesOfContent) {
  const std::vector<double> changes_s{3.0, 7.4, 12.0};
  for (const double hz : {30.0, 60.0, 120.0}) {
    const Motion motion = changing_motion(hz, changes_s, 15.0);
    const auto found = segments(clip_of_motion(motion), SegmentBy::kChange);
    expect_partition(found, static_cast<int>(motion.poses.size()));
    ASSERT_EQ(found.size(), 4U);
    for (std::size_t k = 0; k < changes_s.size(); ++k) {
      EXPECT_NEAR(found[k + 1].first / hz, changes_s[k], 0.2);
    }
  }
}

TEST(FindSegments, ChangesMoveWithTheMotion) {
  const double hz = 30.0;
  const Motion motion = changing_motion(hz, {3.0, 7.4, 12.0}, 15.0);
  Motion later = motion;
  later.first_frame = 600;
  const auto found = segments(clip_of_motion(motion), SegmentBy::kChange);
  expect_ranges(segments(clip_of_motion(later), SegmentBy::kChange), found);
  expect_ranges(
      segments(clip_of_motion(moved(motion, 2.0, 5.0, 1.0)), SegmentBy::kChange), found);
}

TEST(FindSegments, ChangesAreAPartitionOfAnyMotion) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const int count = 1 + static_cast<int>(seed * 97 % 600);
    const LibraryMotion clip = clip_of_motion(random_motion(seed, count, 30.0));
    const auto found = segments(clip, SegmentBy::kChange);
    expect_partition(found, count);
    for (const FrameRange& range : found) {
      if (found.size() > 1) {
        EXPECT_GE(range.last - range.first + 1, 27) << seed;
      }
    }
  }
}

TEST(FindSegments, NoveltyIsZeroWithoutAChange) {
  const std::vector<float> rows(64 * 50, 0.25F);
  for (const double value : novelty(rows)) EXPECT_EQ(value, 0.0);
  EXPECT_TRUE(find_changes(rows).empty());
  EXPECT_TRUE(find_changes({}).empty());
}

}  // namespace
}  // namespace marey::library
