// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Laws that hold for all requests: mirror images, and the order within a step.
#include <algorithm>
#include <string>
#include <vector>

#include "engine/clips/make_clip.h"
#include "engine/engine.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/humanoid.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/engine/made_base.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::engine {
namespace {

/// Mirror image at the plane X = 0. The rest rotations of the body are symmetric.
Pose mirror_image(const Pose& pose, const retarget::BodyMap& map) {
  Pose out = pose;
  out.root_in_world.x = -pose.root_in_world.x;
  const auto turned = [](const glm::dquat& q) {
    return glm::dquat(q.w, q.x, -q.y, -q.z);
  };
  for (std::size_t i = 0; i < pose.parent_from_joint.size(); ++i) {
    out.parent_from_joint[i] = turned(pose.parent_from_joint[i]);
  }
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const auto bone = static_cast<HumanBone>(b);
    const auto from = map.joint_of[b];
    const auto to = map.joint_of[index(mirrored(bone))];
    if (!from || !to) continue;
    out.parent_from_joint[index(*to)] = turned(pose.parent_from_joint[index(*from)]);
  }
  return out;
}

std::shared_ptr<const MotionBase> walks(bool are_mirrored) {
  constexpr int kCycle = 66;
  std::vector<ClipSource> sources;
  for (const auto& [name, hz] : {std::pair{"stroll", 48.0}, std::pair{"walk", 60.0}}) {
    ClipSource source;
    source.name = name;
    source.motion = testing::synthetic_walk(3 * kCycle, 60.0).motion;
    auto& poses = source.motion.poses;
    poses.erase(poses.begin(), poses.begin() + kCycle);
    poses.resize(kCycle + 1);
    source.motion.rate = {hz};
    source.map = *retarget::map_body(source.motion.skeleton);
    if (are_mirrored) {
      for (Pose& pose : poses) pose = mirror_image(pose, source.map);
    }
    source.contacts = retarget::detect_contacts(source.motion, source.map);
    source.loops = true;
    sources.push_back(std::move(source));
  }
  return *MotionBase::make(*make_moves(sources));
}

ActionWish one_arm(EditGroup arm) {
  ActionWish wish;
  wish.clip = "stroll";
  wish.priority = only(arm);
  return wish;
}

ActionWish whole(const char* clip) {
  ActionWish wish;
  wish.clip = clip;
  return wish;
}

TEST(EngineProperties, MirroredRequestsGiveTheMirroredMotion) {
  CharacterSpec spec = made_character();
  spec.start = {0.5, 1.0, 0.3};
  CharacterSpec image = spec;
  image.start = {-0.5, 1.0, -0.3};
  Engine engine = *Engine::make(walks(false));
  Engine other = *Engine::make(walks(true));
  const CharacterId ann = *engine.add(spec);
  const CharacterId bob = *other.add(image);
  for (int step = 0; step < 240; ++step) {
    if (step == 0 || step == 130) {
      ASSERT_TRUE(engine.play(ann, whole("walk")));
      ASSERT_TRUE(other.play(bob, whole("walk")));
    }
    if (step == 50) {
      ASSERT_TRUE(engine.play(ann, whole("stroll")));
      ASSERT_TRUE(other.play(bob, whole("stroll")));
    }
    if (step == 90) {
      ASSERT_TRUE(engine.play(ann, one_arm(EditGroup::kRightArm)));
      ASSERT_TRUE(other.play(bob, one_arm(EditGroup::kLeftArm)));
    }
    engine.advance();
    other.advance();
    const Pose expected = mirror_image(engine.pose(ann), engine.player(ann).map());
    const auto p = world_from_joints(made_skeleton(), other.pose(bob));
    const auto q = world_from_joints(made_skeleton(), expected);
    for (std::size_t i = 0; i < p.size(); ++i) {
      ASSERT_LT(glm::distance(p[i].translation, q[i].translation), 1e-4)
          << "step " << step << ", " << made_skeleton().joints[i].name;
    }
  }
}

TEST(EngineProperties, RequestsForDifferentGroupsMayBeMadeInAnyOrder) {
  Engine engine = *Engine::make(walks(false));
  const CharacterId ann = *engine.add(made_character());
  const CharacterId bob = *engine.add(made_character());
  for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, whole("walk")));
  engine.advance(30);
  ASSERT_TRUE(engine.play(ann, one_arm(EditGroup::kLeftArm)));
  ASSERT_TRUE(engine.play(ann, one_arm(EditGroup::kRightArm)));
  ASSERT_TRUE(engine.play(bob, one_arm(EditGroup::kRightArm)));
  ASSERT_TRUE(engine.play(bob, one_arm(EditGroup::kLeftArm)));
  for (int step = 0; step < 60; ++step) {
    engine.advance();
    ASSERT_EQ(engine.pose(ann).root_in_world, engine.pose(bob).root_in_world) << step;
    ASSERT_EQ(engine.pose(ann).parent_from_joint, engine.pose(bob).parent_from_joint)
        << step;
  }
}

TEST(EngineProperties, CharactersDoNotDependOnTheOrderOfTheirRequests) {
  Engine engine = *Engine::make(walks(false));
  Engine other = *Engine::make(walks(false));
  std::vector<CharacterId> who;
  for (int i = 0; i < 3; ++i) {
    who.push_back(*engine.add(made_character()));
    (void)*other.add(made_character());
  }
  for (const CharacterId id : who) ASSERT_TRUE(engine.play(id, whole("walk")));
  std::reverse(who.begin(), who.end());
  for (const CharacterId id : who) ASSERT_TRUE(other.play(id, whole("walk")));
  engine.advance(100);
  other.advance(100);
  for (const CharacterId id : who) {
    EXPECT_EQ(engine.pose(id).parent_from_joint, other.pose(id).parent_from_joint);
    EXPECT_EQ(engine.pose(id).root_in_world, other.pose(id).root_in_world);
  }
}

}  // namespace
}  // namespace marey::engine
