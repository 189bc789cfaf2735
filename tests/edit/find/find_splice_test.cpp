// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/find_splice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/splice_scene.h"

namespace marey::edit {
namespace {

SpliceWindows whole_windows(const EditState& a, const EditState& b) {
  return {{0, a.frame_count() - 1}, {0, b.frame_count() - 1}};
}

// Exact copies: proves the move and the pair, not the choice between unequal motions.
TEST(FindSplice, FindsTheFrameOfATurnedAndMovedCopy) {
  const EditState walk = splice_walk(0.02);
  const EditState copy =
      moved_on_floor(as_source(walk, {150, 329}, 1), 1.1, {4.0, 0.0, -3.0});
  const auto found = find_splices(walk, copy, {{200, 200}, {0, 179}});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].leave, 200);
  EXPECT_EQ(found[0].enter, 50);
  EXPECT_LT(found[0].match.distance_m, 1e-9);
  const auto place = [](const EditState& state, int frame) {
    return state.motion.poses[static_cast<std::size_t>(frame)].root_in_world;
  };
  EXPECT_LT(glm::distance(found[0].match.a_from_b(place(copy, 90)), place(walk, 240)),
            1e-9 /* m */);
}

TEST(FindSplice, FindsTheSamePhaseOneCycleApart) {
  const EditState walk = splice_walk();
  const auto found = find_splices(walk, walk, {{250, 250}, {100, 180}});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].enter, 250 - kSpliceCycle);
}

TEST(FindSplice, LeavesOutPairsOnOppositeFeet) {
  const EditState walk = splice_walk(0.02);
  FindSpliceOptions options;
  options.max_candidates = 1000;
  options.separation_s = 0.0;
  const auto found = find_splices(walk, walk, whole_windows(walk, walk), options);
  EXPECT_GT(found.size(), 100U);
  for (const SpliceCandidate& pair : found) {
    EXPECT_FALSE(supports_oppose(support_class(walk.contacts, pair.leave),
                                 support_class(walk.contacts, pair.enter)));
  }
}

TEST(FindSplice, AnswersWithNothingIfAllPairsAreOnOppositeFeet) {
  const EditState walk = splice_walk();
  int left = -1;
  int right = -1;
  for (int frame = 0; frame < walk.frame_count(); ++frame) {
    const SupportClass feet = support_class(walk.contacts, frame);
    if (feet == SupportClass::kLeft) left = frame;
    if (feet == SupportClass::kRight) right = frame;
  }
  ASSERT_TRUE(left >= 0 && right >= 0);
  const SpliceWindows pair{{left, left}, {right, right}};
  EXPECT_TRUE(find_splices(walk, walk, pair).empty());
  FindSpliceOptions options;
  options.allow_opposed = true;
  const auto allowed = find_splices(walk, walk, pair, options);
  ASSERT_EQ(allowed.size(), 1U);
  EXPECT_EQ(allowed[0].leave, left);
  EXPECT_EQ(allowed[0].enter, right);
}

// The grid must not miss the pair that an exhaustive search of a part finds.
TEST(FindSplice, SearchesLargeWindowsAsWellAsSmallOnes) {
  const EditState first = splice_walk(0.03, 400);
  const EditState second =
      moved_on_floor(as_source(splice_walk(0.03, 400), {120, 399}, 1), 0.4, {1, 0, 1});
  const auto all = find_splices(first, second, whole_windows(first, second));
  ASSERT_FALSE(all.empty());
  EXPECT_LT(all[0].match.distance_m, 1e-9);
  EXPECT_EQ(all[0].leave - all[0].enter, 120);
}

TEST(FindSplice, WithoutAlignmentThePlaceCounts) {
  const EditState walk = splice_walk();
  FindSpliceOptions options;
  options.align = false;
  const auto found = find_splices(walk, walk, {{250, 250}, {100, 300}}, options);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].enter, 250);
  EXPECT_EQ(found[0].match.a_from_b.turn_rad, 0.0);
}

// A fast walk, and the same played backwards: it travels against its facing direction.
// Turned round its travel would fit, and its body would have to turn within the overlap.
TEST(FindSplice, MotionsOfOppositeTravelFaceTheSameDirection) {
  Motion motion = testing::synthetic_walk(100, 30.0).motion;
  for (Pose& pose : motion.poses) pose.root_in_world.z *= 4.0;
  Motion reversed = motion;
  std::reverse(reversed.poses.begin(), reversed.poses.end());
  const auto walk = make_edit_state(std::move(motion));
  const auto back = make_edit_state(std::move(reversed), {}, 1);
  ASSERT_TRUE(walk && back);
  const auto hips_across = [](const EditState& state, int frame) {
    const auto t = static_cast<std::size_t>(frame);
    return joint_way(state.motion, HumanBone::kLeftUpperLeg)[t] -
           joint_way(state.motion, HumanBone::kRightUpperLeg)[t];
  };
  const auto facing_cosine = [&](const SpliceCandidate& pair) {
    const glm::dvec3 a = hips_across(*walk, pair.leave);
    const glm::dvec3 b = pair.match.a_from_b.rotation() * hips_across(*back, pair.enter);
    return (a.x * b.x + a.z * b.z) / (std::hypot(a.x, a.z) * std::hypot(b.x, b.z));
  };
  FindSpliceOptions options;
  const auto found = find_splices(*walk, *back, whole_windows(*walk, *back), options);
  ASSERT_FALSE(found.empty());
  for (const SpliceCandidate& pair : found) {
    EXPECT_GT(facing_cosine(pair), std::cos(0.5 /* rad */)) << pair.leave;
    EXPECT_NEAR(std::cos(pair.facing_rad), facing_cosine(pair), 0.02);
  }
  // The scene is one in which the cost decides.
  options.facing_m = 0.0;
  const auto turned = find_splices(*walk, *back, whole_windows(*walk, *back), options);
  ASSERT_FALSE(turned.empty());
  EXPECT_LT(facing_cosine(turned.front()), 0.0);
}

}  // namespace
}  // namespace marey::edit
