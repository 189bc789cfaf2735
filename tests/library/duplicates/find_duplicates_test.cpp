// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/duplicates/find_duplicates.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "library/clips/normal_form.h"
#include "library/features/body_features.h"
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/resample.h"
#include "tests/library/moved_motion.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::library {
namespace {

using Rows = std::vector<float>;

struct FeatureTable {
  std::vector<float> values;
  std::vector<std::uint64_t> begins{0};

  int add(const Rows& rows) {
    values.insert(values.end(), rows.begin(), rows.end());
    begins.push_back(values.size() / kFeatureStride);
    return static_cast<int>(begins.size()) - 2;
  }
  [[nodiscard]] ClipRows rows() const { return {values, kFeatureStride, begins}; }
};

Rows features_of_motion(const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return body_features(motion, *map).rows;
}

// Every joint swings about its own axis, at its own rate.
Motion clip_motion(int k, std::size_t frames) {
  testing::Dice dice(static_cast<std::uint64_t>(k) + 100);
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate.hz = 30.0;
  motion.poses.assign(frames, rest_pose(motion.skeleton));
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(
        dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)));
    const double size = dice.between(0.1, 0.5);
    const double rate = dice.between(1.0, 7.0);
    const double phase = dice.between(0.0, 6.0);
    for (std::size_t t = 0; t < motion.poses.size(); ++t) {
      const double angle = size * std::sin(phase + rate * static_cast<double>(t) / 30.0);
      motion.poses[t].parent_from_joint[j] = glm::angleAxis(angle, axis);
    }
  }
  return motion;
}

Motion clip_motion(int k) {
  return clip_motion(k, static_cast<std::size_t>(90 + 7 * (k % 9)));
}

// Motions of one body, none like another.
FeatureTable made_table(int count) {
  FeatureTable table;
  for (int k = 0; k < count; ++k) table.add(features_of_motion(clip_motion(k)));
  return table;
}

Motion part_of_motion(const Motion& motion, int first, int last) {
  LibraryMotion whole{motion, std::vector<FootParts>(motion.poses.size()), {}};
  Motion part = part_of(whole, first, last).motion;
  part.first_frame = 0;
  return part;
}

// Forearms longer, shanks shorter.
Motion on_other_body(Motion motion) {
  for (const bool is_left : {true, false}) {
    const auto stretch = [&](HumanBone left, double factor) {
      const auto joint = motion.skeleton.find(is_left ? left : mirrored(left));
      motion.skeleton.joints[index(*joint)].parent_from_joint.translation *= factor;
    };
    stretch(HumanBone::kLeftHand, 1.15);
    stretch(HumanBone::kLeftFoot, 0.93);
  }
  return motion;
}

std::optional<DuplicateClip> entry_of(const FeatureTable& table, int clip) {
  for (const DuplicateClip& one : find_duplicates(table.rows())) {
    if (one.clip == clip) return one;
  }
  return std::nullopt;
}

TEST(FindDuplicates, FindsNoneAmongDifferentMotions) {
  EXPECT_TRUE(find_duplicates(made_table(40).rows()).empty());
}

TEST(FindDuplicates, FindsEqualRowsAlsoOfStillBodies) {
  FeatureTable table = made_table(5);
  const int copy = table.add(features_of_motion(clip_motion(2)));
  Motion still = clip_motion(0);
  still.poses.assign(30, still.poses[0]);
  const int first_still = table.add(features_of_motion(still));
  const int second_still = table.add(features_of_motion(still));
  const auto found = find_duplicates(table.rows());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].clip, copy);
  EXPECT_EQ(found[0].original, 2);
  EXPECT_FALSE(found[0].is_mirrored);
  EXPECT_FALSE(found[0].is_contained);
  EXPECT_EQ(found[1].clip, second_still);
  EXPECT_EQ(found[1].original, first_still);
}

TEST(FindDuplicates, FindsTheSameMotionAtAnotherRateHeightAndPlace) {
  for (const double hz : {24.0, 60.0, 120.0}) {
    FeatureTable table = made_table(12);
    for (int k = 0; k < 12; ++k) {
      Motion copy = moved(resample(clip_motion(k), FrameRate{hz}), 1.0, 2.0, -3.0);
      for (Pose& pose : copy.poses) pose.root_in_world.y += 0.05;
      table.add(features_of_motion(copy));
    }
    const auto found = find_duplicates(table.rows());
    ASSERT_EQ(found.size(), 12U) << hz;
    for (int k = 0; k < 12; ++k) {
      const DuplicateClip& one = found[static_cast<std::size_t>(k)];
      EXPECT_EQ(one.clip, 12 + k);
      EXPECT_EQ(one.original, k);
      EXPECT_NEAR(one.shift_s, 0.0, 0.03);
    }
  }
}

TEST(FindDuplicates, FindsPartsAndTheirPlace) {
  FeatureTable table = made_table(12);
  for (int k = 0; k < 12; ++k) {
    table.add(features_of_motion(part_of_motion(clip_motion(k), 22, 80)));
  }
  const auto found = find_duplicates(table.rows());
  ASSERT_EQ(found.size(), 12U);
  for (int k = 0; k < 12; ++k) {
    const DuplicateClip& one = found[static_cast<std::size_t>(k)];
    EXPECT_EQ(one.original, k);
    EXPECT_TRUE(one.is_contained);
    EXPECT_NEAR(one.shift_s, 22.0 / 30.0, 0.03);
  }
}

TEST(FindDuplicates, KeepsTheLongerOneOfTwo) {
  FeatureTable table;
  const int part = table.add(features_of_motion(part_of_motion(clip_motion(0), 20, 80)));
  const int whole = table.add(features_of_motion(clip_motion(0)));
  const auto found = find_duplicates(table.rows());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].clip, part);
  EXPECT_EQ(found[0].original, whole);
}

TEST(FindDuplicates, FindsMirrorImages) {
  FeatureTable table = made_table(8);
  const int whole = table.add(mirrored_features(features_of_motion(clip_motion(3))));
  const int part = table.add(
      mirrored_features(features_of_motion(part_of_motion(clip_motion(5), 15, 80))));
  const auto first = entry_of(table, whole);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->original, 3);
  EXPECT_TRUE(first->is_mirrored);
  EXPECT_FALSE(first->is_contained);
  const auto second = entry_of(table, part);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->original, 5);
  EXPECT_TRUE(second->is_mirrored);
  EXPECT_TRUE(second->is_contained);
}

TEST(FindDuplicates, FindsTheMotionOfAnotherBody) {
  FeatureTable table = made_table(12);
  for (int k = 0; k < 12; ++k) {
    table.add(
        features_of_motion(resample(on_other_body(clip_motion(k)), FrameRate{60.0})));
  }
  const auto found = find_duplicates(table.rows());
  ASSERT_EQ(found.size(), 12U);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(found[static_cast<std::size_t>(k)].original, k);
}

TEST(FindDuplicates, ChoosesTheFirstOfManyCopies) {
  FeatureTable table = made_table(4);
  for (const double hz : {60.0, 24.0, 120.0, 90.0}) {
    table.add(features_of_motion(resample(clip_motion(1), FrameRate{hz})));
  }
  const auto found = find_duplicates(table.rows());
  ASSERT_EQ(found.size(), 4U);
  for (const DuplicateClip& one : found) EXPECT_EQ(one.original, 1);
}

// "Nearly as long" is not transitive: 95 and 107 rows differ by more than a tenth, but
// both are nearly as long as 100.
TEST(FindDuplicates, KeepsOneOfThreeCutsOfRisingLengths) {
  const Motion whole = clip_motion(1, 330);
  FeatureTable table;
  for (const int rows : {95, 100, 107}) {
    table.add(features_of_motion(part_of_motion(whole, 0, 3 * (rows - 1))));
    ASSERT_EQ(
        table.values.size() / kFeatureStride - table.begins[table.begins.size() - 2],
        static_cast<std::size_t>(rows));
  }
  const auto found = find_duplicates(table.rows());
  ASSERT_EQ(found.size(), 2U);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(found[static_cast<std::size_t>(k)].clip, k);
    EXPECT_EQ(found[static_cast<std::size_t>(k)].original, 2);
  }
}

TEST(FindDuplicates, KeepsExactlyOneClipOfEachFamilyOfCuts) {
  constexpr int kFamilies = 3;
  constexpr int kCuts = 6;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    testing::Dice dice(seed);
    const auto below = [&](int count) {
      return static_cast<int>(dice.between(0.0, count - 0.001));
    };
    std::vector<std::pair<int, Rows>> clips;
    for (int family = 0; family < kFamilies; ++family) {
      const Motion whole = clip_motion(family, 360);
      // Each cut is within the one before, so that all of them agree.
      int first = below(10);
      int last = 359 - below(10);
      for (int cut = 0; cut < kCuts; ++cut) {
        clips.emplace_back(family,
                           features_of_motion(part_of_motion(whole, first, last)));
        first += below(12);
        last -= below(20);
      }
    }
    for (std::size_t k = clips.size() - 1; k > 0; --k) {
      std::swap(clips[k],
                clips[static_cast<std::size_t>(below(static_cast<int>(k) + 1))]);
    }
    FeatureTable table;
    for (const auto& clip : clips) table.add(clip.second);
    std::vector<int> originals(clips.size(), -1);
    for (const DuplicateClip& one : find_duplicates(table.rows())) {
      originals[static_cast<std::size_t>(one.clip)] = one.original;
    }
    std::vector<int> kept(kFamilies, 0);
    for (std::size_t k = 0; k < clips.size(); ++k) {
      if (originals[k] < 0) {
        ++kept[static_cast<std::size_t>(clips[k].first)];
        continue;
      }
      const auto original = static_cast<std::size_t>(originals[k]);
      EXPECT_LT(originals[original], 0) << "seed " << seed << ": clip " << k;
      EXPECT_EQ(clips[original].first, clips[k].first) << "seed " << seed;
    }
    EXPECT_EQ(kept, std::vector<int>(kFamilies, 1)) << "seed " << seed;
  }
}

// A repetition has the same postures, but at times that differ by more than 0.1 s.
TEST(FindDuplicates, DoesNotFindARepetition) {
  FeatureTable table = made_table(8);
  for (int k = 0; k < 8; ++k) {
    Motion again = clip_motion(k);
    const Motion slow = resample(again, FrameRate{36.0});
    const std::size_t half = again.poses.size() / 2;
    for (std::size_t t = 0; t < half; ++t) again.poses[t] = slow.poses[t];
    table.add(features_of_motion(part_of_motion(again, 0, static_cast<int>(half) - 1)));
  }
  for (const DuplicateClip& one : find_duplicates(table.rows())) {
    ADD_FAILURE() << one.clip << " of " << one.original << ", " << one.distance;
  }
}

TEST(FindDuplicates, IsTheSameForAnyNumberOfThreads) {
  FeatureTable table = made_table(150);
  for (int k = 0; k < 150; k += 3) {
    table.add(features_of_motion(resample(clip_motion(k), FrameRate{60.0})));
  }
  const auto one = find_duplicates(table.rows(), {}, 1);
  const auto four = find_duplicates(table.rows(), {}, 4);
  ASSERT_EQ(one.size(), 50U);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].clip, four[k].clip);
    EXPECT_EQ(one[k].original, four[k].original);
    EXPECT_EQ(one[k].distance, four[k].distance);
    EXPECT_EQ(one[k].shift_s, four[k].shift_s);
  }
}

TEST(FindDuplicates, AcceptsEmptyAndShortClips) {
  FeatureTable table;
  EXPECT_TRUE(find_duplicates(table.rows()).empty());
  table.add({});
  table.add(Rows(kFeatureStride, 0.5F));
  table.add({});
  table.add(Rows(2 * kFeatureStride, 0.5F));
  table.add(Rows(kFeatureStride, 0.25F));
  EXPECT_TRUE(find_duplicates(table.rows()).empty());
}

}  // namespace
}  // namespace marey::library
