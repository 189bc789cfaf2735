// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/segments/trim_idle.h"

#include <cmath>
#include <cstddef>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/library/library_motion.h"
#include "tests/library/quality/quality_scenes.h"

namespace marey::library {
namespace {

TrimmedIdle trimmed(const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return trim_idle(motion, *map);
}

// Appends a pose for some frames.
void hold(Motion& motion, const Pose& pose, int frames) {
  motion.poses.insert(motion.poses.end(), static_cast<std::size_t>(frames), pose);
}

// A walk with `t_pose` frames of the T-pose and `still` frames of its first pose before
// it, and the same after it.
Motion walk_between(int t_pose, int still, double hz) {
  const Motion walk = walking_clip(static_cast<int>(2.0 * hz), hz).motion;
  Motion out = walk;
  out.poses.clear();
  hold(out, rest_pose(walk.skeleton), t_pose);
  hold(out, walk.poses.front(), still);
  out.poses.insert(out.poses.end(), walk.poses.begin(), walk.poses.end());
  hold(out, walk.poses.back(), still);
  hold(out, rest_pose(walk.skeleton), t_pose);
  return out;
}

TEST(TrimIdle, KeepsAMotionThatBeginsAndEndsWithMovement) {
  const TrimmedIdle out = trimmed(walk_between(0, 0, 60.0));
  EXPECT_EQ(out.kept.first, 0);
  EXPECT_EQ(out.kept.last, 119);
  EXPECT_TRUE(out.cut.empty());
  EXPECT_TRUE(out.events.empty());
}

TEST(TrimIdle, CutsTheTPoseAtBothEnds) {
  for (const int frames : {1, 40}) {
    const TrimmedIdle out = trimmed(walk_between(frames, 0, 60.0));
    EXPECT_EQ(out.kept.first, frames);
    EXPECT_EQ(out.kept.last, frames + 119);
    ASSERT_EQ(out.cut.size(), 2U);
    EXPECT_EQ(out.cut[0].name, "tpose");
    EXPECT_EQ(out.cut[0].frames.first, 0);
    EXPECT_EQ(out.cut[0].frames.last, frames - 1);
    EXPECT_EQ(out.cut[1].frames.first, frames + 120);
    EXPECT_EQ(out.cut[1].frames.last, 2 * frames + 119);
    ASSERT_EQ(out.events.size(), 2U);
    EXPECT_EQ(out.events[0].frame, 0);
    EXPECT_EQ(out.events[1].frame, 119);
    EXPECT_EQ(out.events[1].name, "tpose");
  }
}

TEST(TrimIdle, CutsStillnessButForAQuarterOfASecond) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    const auto still = static_cast<int>(1.0 * hz);
    const TrimmedIdle out = trimmed(walk_between(0, still, hz));
    EXPECT_NEAR(out.kept.first, still - 0.25 * hz, 0.1 * hz + 1.0) << hz;
    EXPECT_NEAR(out.kept.last, 3.0 * hz + 0.25 * hz, 0.1 * hz + 1.0) << hz;
    ASSERT_EQ(out.cut.size(), 2U);
    EXPECT_EQ(out.cut[0].name, "still");
  }
}

TEST(TrimIdle, CutsATPoseAndThenStillness) {
  const TrimmedIdle out = trimmed(walk_between(30, 60, 60.0));
  ASSERT_EQ(out.cut.size(), 4U);
  EXPECT_EQ(out.cut[0].name, "tpose");
  EXPECT_EQ(out.cut[1].name, "still");
  EXPECT_EQ(out.cut[2].name, "still");
  EXPECT_EQ(out.cut[3].name, "tpose");
  // Disjoint, ascending, and all of them outside of the kept part.
  EXPECT_EQ(out.cut[0].frames.first, 0);
  EXPECT_EQ(out.cut[1].frames.first, out.cut[0].frames.last + 1);
  EXPECT_EQ(out.kept.first, out.cut[1].frames.last + 1);
  EXPECT_EQ(out.cut[2].frames.first, out.kept.last + 1);
  EXPECT_EQ(out.cut[3].frames.first, out.cut[2].frames.last + 1);
}

TEST(TrimIdle, KeepsShortStillness) {
  const TrimmedIdle out = trimmed(walk_between(0, 12, 60.0));
  EXPECT_EQ(out.kept.first, 0);
  EXPECT_EQ(out.kept.last, 143);
}

TEST(TrimIdle, KeepsAMotionThatIsIdleAllTheTime) {
  for (const int frames : {1, 2, 200}) {
    const LibraryMotion standing = standing_clip(frames, 60.0);
    const TrimmedIdle out = trimmed(standing.motion);
    EXPECT_EQ(out.kept.first, 0);
    EXPECT_EQ(out.kept.last, frames - 1);
    EXPECT_TRUE(out.cut.empty());
  }
}

}  // namespace
}  // namespace marey::library
