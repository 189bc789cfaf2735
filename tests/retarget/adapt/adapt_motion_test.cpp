// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/adapt_motion.h"

#include <algorithm>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/pose.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

constexpr int kFrames = 90;
constexpr double kRate_hz = 30.0;
// Single precision, over a body's height and a walk's length.
constexpr double kSingle_m = 1e-5;

struct Scene {
  testing::SyntheticWalk walk = testing::synthetic_walk(kFrames, kRate_hz);
  BodyMap map = mapped(walk.motion.skeleton);
  Character character;
  std::vector<SupportTrack> supports =
      plan_supports(walk.motion, map, detect_contacts(walk.motion, map));

  Scene() {
    CharacterTraits traits;
    traits.loads = {{"bag", {"leftHand", {}}, 10.0}};
    character = *make_character("walker", walk.motion.skeleton, map, traits);
  }
  [[nodiscard]] std::vector<RigidTransform> world(const Motion& motion, int frame) const {
    return world_from_joints(motion.skeleton,
                             motion.poses[static_cast<std::size_t>(frame)]);
  }
  [[nodiscard]] glm::dvec3 hand(const Motion& motion, int frame) const {
    return world(motion, frame)[index(*motion.skeleton.find(HumanBone::kLeftHand))]
        .translation;
  }
  /// Centre of mass of the body, and of the bag if it is carried.
  [[nodiscard]] glm::dvec3 com(const Motion& motion, int frame, bool carries) const {
    const auto joints = world(motion, frame);
    glm::dvec3 sum(0.0);
    double mass_kg = 0.0;
    const auto add = [&](const PointMass& m) {
      sum += m.mass_kg * (joints[index(m.joint)] * m.p_in_joint);
      mass_kg += m.mass_kg;
    };
    for (const PointMass& mass : character.masses) add(mass);
    if (carries) add(character.loads.front().mass);
    return sum / mass_kg;
  }
};

/// The hand on a place near its path from 1 s to 1.4 s, extended by an eighth of a frame.
ConstraintSet hand_near(const Scene& scene) {
  Constraint c;
  c.id = "hand";
  c.point.segment = "leftHand";
  c.goal = DistanceToPoint{
      0.0, scene.hand(scene.walk.motion, 36) + glm::dvec3(-0.2, 0.1, 0.1)};
  constexpr double kEdge_s = 0.125 / kRate_hz;
  c.activation = {0.8 - kEdge_s, 1.4 + kEdge_s, 0.2, 0.2};
  return {{c}, {}};
}

TEST(AdaptMotion, WithoutWishesIsTheMotion) {
  const Scene scene;
  const auto adapted = adapt_motion(scene.walk.motion, scene.character, {}, {});
  ASSERT_TRUE(adapted) << adapted.error().message();
  for (int t = 0; t < kFrames; ++t) {
    const auto is = scene.world(adapted->motion, t);
    const auto was = scene.world(scene.walk.motion, t);
    for (std::size_t j = 0; j < is.size(); ++j) {
      ASSERT_LT(glm::distance(is[j].translation, was[j].translation), kSingle_m);
    }
  }
}

TEST(AdaptMotion, CountsWhatItKept) {
  const Scene scene;
  const ConstraintSet set = hand_near(scene);
  std::vector<int> reported;
  const auto adapted = adapt_motion(
      scene.walk.motion, scene.character, set, scene.supports, {}, [&](int done, int) {
        reported.push_back(done);
      });
  ASSERT_TRUE(adapted) << adapted.error().message();
  EXPECT_EQ(reported.size(), static_cast<std::size_t>(kFrames));
  EXPECT_DOUBLE_EQ(adapted->motion.rate.hz, kRate_hz);
  ASSERT_EQ(adapted->constraints.size(), 1U);
  const KeptConstraint& hand = adapted->constraints.front();
  EXPECT_EQ(hand.active_frames, 13);
  EXPECT_EQ(hand.met_frames, 13);
  const glm::dvec3 target =
      std::get<DistanceToPoint>(set.constraints.front().goal).p_in_world;
  double worst_m = 0.0;
  double sum_m = 0.0;
  for (int t = 30; t <= 42; ++t) {
    const double error_m = glm::distance(scene.hand(adapted->motion, t), target);
    worst_m = std::max(worst_m, error_m);
    sum_m += error_m;
  }
  EXPECT_NEAR(hand.worst_error_m, worst_m, 1e-12);
  EXPECT_NEAR(hand.mean_error_m, sum_m / 13.0, 1e-12);
  EXPECT_LT(worst_m, 1e-3 + kSingle_m);
  ASSERT_EQ(adapted->supports.size(), scene.supports.size());
  for (const KeptConstraint& support : adapted->supports) {
    EXPECT_TRUE(support.is_support);
    EXPECT_GT(support.active_frames, 3);
    EXPECT_LT(support.worst_error_m, 1e-4) << support.id;
  }
}

// The fully active frames are exactly the contact frames of a track, for any runs.
TEST(AdaptMotion, SupportsAreActiveWhileTheyBear) {
  const Scene scene;
  const auto adapted =
      adapt_motion(scene.walk.motion, scene.character, {}, scene.supports);
  ASSERT_TRUE(adapted) << adapted.error().message();
  for (std::size_t i = 0; i < scene.supports.size(); ++i) {
    int bearing = 0;
    for (const FrameRange& run : scene.supports[i].bears) {
      bearing += run.last - run.first + 1;
    }
    EXPECT_EQ(adapted->supports[i].active_frames, bearing) << adapted->supports[i].id;
  }
}

// With 10 kg in one hand the body is as balanced as without.
TEST(AdaptMotion, ALoadIsBalancedAgainst) {
  const Scene scene;
  AdaptMotionOptions options;
  options.adapt.balance = BalanceMode::kHorizontal;
  options.carried = {"bag"};
  const auto adapted =
      adapt_motion(scene.walk.motion, scene.character, {}, scene.supports, options);
  ASSERT_TRUE(adapted) << adapted.error().message();
  for (int t = 0; t < kFrames; t += 5) {
    const glm::dvec3 wanted = scene.com(scene.walk.motion, t, false);
    const glm::dvec3 unbalanced = scene.com(scene.walk.motion, t, true);
    const glm::dvec3 is = scene.com(adapted->motion, t, true);
    const auto away = [&](const glm::dvec3& p) {
      return glm::length(glm::dvec2(p.x - wanted.x, p.z - wanted.z));
    };
    EXPECT_GT(away(unbalanced), 0.05);  // An eighth of the mass, 0.7 m aside.
    EXPECT_LT(away(is), 0.005) << t;
  }
  EXPECT_LT(adapted->worst_balance_error_m, 0.005);
}

// Footprints move the centre of mass, with a load as without.
TEST(AdaptMotion, ALoadIsBalancedWhereFootprintsTakeTheBody) {
  Scene scene;
  for (SupportTrack& track : scene.supports) {
    for (glm::dvec3& p : track.p_in_world) p.x += 0.3;
  }
  AdaptMotionOptions options;
  options.adapt.balance = BalanceMode::kHorizontal;
  const auto empty_handed =
      adapt_motion(scene.walk.motion, scene.character, {}, scene.supports, options);
  options.carried = {"bag"};
  const auto loaded =
      adapt_motion(scene.walk.motion, scene.character, {}, scene.supports, options);
  ASSERT_TRUE(empty_handed && loaded);
  double furthest_m = 0.0;
  for (int t = 0; t < kFrames; t += 5) {
    const glm::dvec3 without = scene.com(empty_handed->motion, t, false);
    const glm::dvec3 with = scene.com(loaded->motion, t, true);
    EXPECT_LT(glm::length(glm::dvec2(with.x - without.x, with.z - without.z)), 0.005)
        << t;
    furthest_m =
        std::max(furthest_m, without.x - scene.com(scene.walk.motion, t, false).x);
  }
  EXPECT_GT(furthest_m, 0.25) << "footprints do not move the body";
}

// A constraint without a fade moves the hand by the whole distance in a frame or two. One
// that fades in over 0.2 s accelerates it by 5.8 / 0.04 of the distance, the maximum of a
// quintic, and by half as much again because the distance grows meanwhile.
TEST(AdaptMotion, ReportsJointAndFrameOfTheLargestAddedAcceleration) {
  const Scene scene;
  ConstraintSet set = hand_near(scene);
  const double way_m =
      glm::distance(scene.hand(scene.walk.motion, 24),
                    std::get<DistanceToPoint>(set.constraints.front().goal).p_in_world);
  const auto soft = adapt_motion(scene.walk.motion, scene.character, set, {});
  set.constraints.front().activation.start_duration_s = 0.0;
  const auto hard = adapt_motion(scene.walk.motion, scene.character, set, {});
  ASSERT_TRUE(soft && hard);
  EXPECT_LT(soft->added.m_per_s2, 1.5 * 5.8 / 0.04 * way_m);
  EXPECT_GT(hard->added.m_per_s2, 0.9 * way_m * kRate_hz * kRate_hz);
  EXPECT_NEAR(hard->added.frame, 24, 1);
  EXPECT_EQ(scene.character.skeleton[hard->added.joint].name, "leftHand");
}

TEST(AdaptMotion, NamesALoadThatIsNotThere) {
  const Scene scene;
  AdaptMotionOptions options;
  options.carried = {"bags"};
  const auto adapted = adapt_motion(scene.walk.motion, scene.character, {}, {}, options);
  ASSERT_FALSE(adapted);
  EXPECT_EQ(adapted.error().code, Errc::kBadInput);
  EXPECT_NE(adapted.error().message().find("perhaps you mean \"bag\""), std::string::npos)
      << adapted.error().message();
}

// Feet start and end their stances at every step: the postures in between are in balance,
// too.
TEST(AdaptMotion, KeepsBalanceWhileFeetComeAndGo) {
  const Scene scene;
  for (const Method method : {Method::kStrict, Method::kThesis}) {
    AdaptMotionOptions options;
    options.adapt.method = method;
    options.adapt.balance = BalanceMode::kHorizontal;
    const auto adapted =
        adapt_motion(scene.walk.motion, scene.character, {}, scene.supports, options);
    ASSERT_TRUE(adapted) << adapted.error().message();
    EXPECT_LT(adapted->worst_balance_error_m, options.adapt.balance_precision_m);
    for (const KeptConstraint& support : adapted->supports) {
      EXPECT_LT(support.worst_error_m, kSingle_m) << support.id;
    }
  }
}

}  // namespace
}  // namespace marey::retarget
