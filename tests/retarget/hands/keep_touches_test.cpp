// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/keep_touches.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/check_constraints.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/hand_scenes.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using P = VolumePart;

RetargetedMotion refined(const Motion& source,
                         const Skeleton& avatar,
                         StillPlace still = StillPlace::kScaled) {
  RetargetOptions options;
  options.hands.emplace().keep.still = still;
  Result<RetargetedMotion> out = retarget_motion(source, avatar, options);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return *std::move(out);
}

double gap_in(const Motion& motion, std::size_t t, P a, P b) {
  const BodyVolume volume = average_volume(motion.skeleton, mapped(motion.skeleton));
  return gap_m(volume, world_from_joints(motion.skeleton, motion.poses[t]), a, b);
}

// Hands together for 0.2 s, apart for 0.2 s, repeatedly.
Motion applause() {
  const Motion one = hands_go_to(clapping());
  Motion out = one;
  out.poses.clear();
  const auto add = [&](int from, int to) {
    const int step = from < to ? 1 : -1;
    for (int t = from; t != to; t += step) {
      out.poses.push_back(one.poses[static_cast<std::size_t>(t)]);
    }
  };
  add(0, 96);
  for (int i = 0; i < 5; ++i) {
    add(145, 157);  // Still together, then
    add(157, 145);  // hardly apart and together again.
  }
  add(145, kSceneFrames);
  return out;
}

TEST(KeepTouches, KeepsApplauseTogether) {
  const Motion source = applause();
  for (const Skeleton& avatar : {broad(1.4), testing::child(), testing::giant()}) {
    const auto out = refined(source, avatar);
    ASSERT_FALSE(out.report.hands.touches.touches.empty());
    for (const Touch& touch : out.report.hands.touches.touches) {
      for (int t = touch.frames.first; t <= touch.frames.last; t += 3) {
        const auto i = static_cast<std::size_t>(t);
        EXPECT_NEAR(gap_in(out.motion, i, P::kLeftHand, P::kRightHand),
                    gap_in(source, i, P::kLeftHand, P::kRightHand),
                    0.01)
            << "frame " << t;
      }
    }
  }
}

// Both hands on the belly, and one on the other: two touches of each hand.
TEST(KeepTouches, KeepsFoldedHandsOnTheBellyAndOnEachOther) {
  HandPlaces places = hand_on_belly();
  places[1] = places[0];
  places[1]->world_from_t_pose = glm::conjugate(places[0]->world_from_t_pose);
  const BodyVolume volume = average_volume(adult(), mapped(adult()));
  places[1]->middle_in_world.z += 2.0 * volume[P::kLeftHand]->radius_m + 0.002;
  const Motion source = hands_go_to(places);
  ASSERT_LT(gap_in(source, 120, P::kLeftHand, P::kRightHand), 0.005);
  for (const Skeleton& avatar : {broad(1.3), testing::child(), testing::giant()}) {
    const auto out = refined(source, avatar);
    EXPECT_NEAR(gap_in(out.motion, 120, P::kLeftHand, P::kAbdomen), 0.003, 0.01);
    EXPECT_NEAR(gap_in(out.motion, 120, P::kLeftHand, P::kRightHand), 0.002, 0.01);
  }
}

// A body that moves about a hand on a table; the hand stays within a millimetre.
Motion leaning() {
  const Motion raised = hands_go_to(
      {HandPlace{{0.25, 1.0, 0.45}, glm::angleAxis(-1.5708, glm::dvec3(0, 1, 0))}, {}});
  const BodyMap map = mapped(raised.skeleton);
  Motion out = raised;
  out.poses.clear();
  const std::size_t hand = index(map.limbs[0]->end);
  const auto wrist_of = [&](const Pose& pose) {
    return world_from_joints(raised.skeleton, pose)[hand].translation;
  };
  for (int t = 0; t < 90; ++t) {
    Pose pose = raised.poses[120];
    glm::dquat& shoulder = pose.parent_from_joint[index(map.limbs[0]->upper)];
    shoulder = glm::angleAxis(0.006 * t, glm::dvec3(1, 0, 0)) * shoulder;
    pose.root_in_world += wrist_of(raised.poses[120]) - wrist_of(pose);
    out.poses.push_back(pose);
  }
  return out;
}

TEST(KeepTouches, KeepsAHandThatLeansWhereItLeans) {
  const Motion source = leaning();
  const auto middle_of = [](const Motion& motion, std::size_t t) {
    const BodyVolume v = average_volume(motion.skeleton, mapped(motion.skeleton));
    const Capsule& hand = *v[P::kLeftHand];
    return world_from_joints(motion.skeleton, motion.poses[t])[index(hand.joint)] *
           axis_point_in_joint(hand, 0.0);
  };
  for (const StillPlace still : {StillPlace::kScaled, StillPlace::kKept}) {
    const Skeleton avatar = make_humanoid(average_proportions(1.65));
    const auto out = refined(source, avatar, still);
    ASSERT_FALSE(out.report.hands.touches.still.empty());
    const FrameRange frames = out.report.hands.touches.still[0].frames;
    const double scale = still == StillPlace::kKept ? 1.0 : 1.65 / 1.75;
    for (int t = frames.first; t <= frames.last; t += 5) {
      const auto i = static_cast<std::size_t>(t);
      // Height of its own soles.
      const double rise = still == StillPlace::kKept ? 0.0 : 0.01;
      EXPECT_LT(glm::distance(middle_of(out.motion, i), scale * middle_of(source, i)),
                0.01 + rise);
    }
  }
}

TEST(KeepTouches, GivesConstraintsThatAdaptationMeets) {
  const Motion source = hands_go_to(hands_on_hips());
  const Skeleton avatar = testing::long_legs();
  RetargetOptions options;
  Result<RetargetedMotion> plain = retarget_motion(source, avatar, options);
  ASSERT_TRUE(plain);
  const BodyMap from = mapped(source.skeleton);
  const BodyMap to = mapped(avatar);
  const Touches touches =
      find_touches(source, from, average_volume(source.skeleton, from));
  const ConstraintSet set =
      constraints_of(touches, avatar, to, average_volume(avatar, to), 0, source.rate);
  ASSERT_NE(set.find("left hand on pelvis 1"), nullptr);
  const auto character = make_character("avatar", avatar, to);
  ASSERT_TRUE(character);
  const auto supports = plan_supports(plain->motion, to, plain->report.contacts);
  const auto adapted = adapt_motion(plain->motion, *character, set, supports);
  ASSERT_TRUE(adapted) << adapted.error().message();
  for (const KeptConstraint& kept : adapted->constraints) {
    if (kept.id.find("pelvis") == std::string::npos) continue;
    EXPECT_LT(kept.worst_error_m, 0.01) << kept.id;
  }
  for (const KeptConstraint& kept : adapted->supports) {
    EXPECT_LT(kept.worst_error_m, 1e-3) << kept.id;
  }
}

}  // namespace
}  // namespace marey::retarget
