// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/make_clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/clips/motion_base.h"
#include "engine/clips/rig.h"
#include "engine/clips/sample_clip.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::engine {
namespace {

ClipSource random_source(std::uint64_t seed, int frames = 6) {
  testing::Dice dice(seed);
  ClipSource source;
  source.name = "random";
  source.motion.skeleton = testing::random_humanoid(dice);
  source.motion.rate = {30.0};
  for (int i = 0; i < frames; ++i) {
    source.motion.poses.push_back(testing::random_pose(source.motion.skeleton, dice));
  }
  source.map = *retarget::map_body(source.motion.skeleton);
  source.contacts.frame_count = frames;
  return source;
}

TEST(MakeClip, HoldsEveryPostureOfItsBody) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ClipSource source = random_source(seed);
    const std::vector<retarget::BodyMap> bodies{source.map};
    const PostureLayout layout = choose_layout(bodies);
    const auto clip = make_clip(source, layout);
    ASSERT_TRUE(clip);
    for (std::size_t t = 0; t < clip->frames.size(); ++t) {
      RootPlace root = path_at(*clip, static_cast<double>(t) / 30.0);
      root.x_m *= source.map.leg_length_m;
      root.z_m *= source.map.leg_length_m;
      BlendPosture posture;
      sample_clip(*clip, static_cast<double>(t) / 30.0, posture);
      retarget::NormalizedPose normalized;
      to_normalized(posture, layout, root, source.map.leg_length_m, normalized);
      const Pose shown = retarget::expand(normalized, source.motion.skeleton, source.map);
      const auto p = world_from_joints(source.motion.skeleton, shown);
      const auto q = world_from_joints(source.motion.skeleton, source.motion.poses[t]);
      for (std::size_t j = 0; j < p.size(); ++j) {
        if (!source.motion.skeleton.joints[j].bone) continue;
        // A limb that is nearly straight loses digits in its fold.
        EXPECT_LT(glm::distance(p[j].translation, q[j].translation), 2e-4)
            << seed << " " << t << " " << j;
      }
    }
  }
}

TEST(MakeClip, PlacesFeetAsTheBodyDoes) {
  const ClipSource source = random_source(7);
  const std::vector<retarget::BodyMap> bodies{source.map};
  const auto clip = make_clip(source, choose_layout(bodies));
  ASSERT_TRUE(clip);
  const Rig rig = make_rig(source.motion.skeleton, source.map);
  for (std::size_t t = 0; t < clip->frames.size(); ++t) {
    const auto world = world_from_joints(source.motion.skeleton, source.motion.poses[t]);
    const FootPlaces feet = foot_places(rig, clip->frames[t]);
    const double heading = static_cast<double>(clip->path[t].heading_rad);
    const glm::dquat turn = glm::angleAxis(heading, glm::dvec3(0, 1, 0));
    for (std::size_t side = 0; side < 2; ++side) {
      const glm::dvec3 hips = world[index(source.map.hips())].translation;
      const glm::dvec3 ankle =
          world[index(source.map.leg(static_cast<int>(side)).end)].translation;
      const glm::dvec3 found = hips + source.map.leg_length_m * (turn * feet.ankle[side]);
      EXPECT_LT(glm::distance(found, ankle), 2e-4) << t;
    }
  }
}

TEST(MakeClip, RefusesBadMotions) {
  const auto refuses = [](ClipSource source) {
    const std::vector<ClipSource> sources{std::move(source)};
    return !make_moves(sources);
  };
  ClipSource short_clip = random_source(1, 1);
  EXPECT_TRUE(refuses(short_clip));
  ClipSource nan = random_source(1);
  nan.motion.poses[2].root_in_world.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuses(nan));
  ClipSource open = random_source(1);
  open.loops = true;
  EXPECT_TRUE(refuses(open));
  ClipSource unnamed = random_source(1);
  unnamed.name.clear();
  EXPECT_TRUE(refuses(unnamed));
  const std::vector<ClipSource> twice{random_source(1), random_source(2)};
  EXPECT_FALSE(make_moves(twice));
}

TEST(MotionBase, RefusesDamagedClipsByName) {
  const std::vector<ClipSource> sources{random_source(3)};
  const MoveSet good = *make_moves(sources);
  EXPECT_TRUE(MotionBase::make(good));
  std::vector<MoveSet> bad(4, good);
  bad[0].clips[0].frames[1].x[3] = 2.0F;
  bad[1].clips[0].path.pop_back();
  bad[2].clips[0].rate_hz = 0.0F;
  bad[3].clips[0].contacts[0] = {{0.1F, 0.05F}};
  for (const MoveSet& moves : bad) {
    const auto base = MotionBase::make(moves);
    ASSERT_FALSE(base);
    EXPECT_NE(base.error().where.find("random"), std::string::npos);
  }
}

TEST(RootPlace, MovesBackToWhereItWas) {
  const RootPlace a{1.0, -2.0, 0.8};
  const RootPlace b{-0.5, 3.0, 4.0};
  const RootPlace c = moved(a, relative(a, b));
  EXPECT_NEAR(c.x_m, b.x_m, 1e-12);
  EXPECT_NEAR(c.z_m, b.z_m, 1e-12);
  EXPECT_NEAR(c.heading_rad, b.heading_rad, 1e-12);
}

}  // namespace
}  // namespace marey::engine
