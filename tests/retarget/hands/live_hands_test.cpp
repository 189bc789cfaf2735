// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/live_hands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/motion/live_retarget.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/hand_scenes.h"
#include "tests/retarget/joint_path.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using P = VolumePart;

struct Scene {
  const char* name;
  HandPlaces (*places)();
  int side;
  P part;
};
constexpr std::array kScenes{Scene{"clap", clapping, 0, P::kRightHand},
                             Scene{"head", hand_on_head, 0, P::kHead},
                             Scene{"left hip", hands_on_hips, 0, P::kPelvis},
                             Scene{"right hip", hands_on_hips, 1, P::kPelvis},
                             Scene{"belly", hand_on_belly, 0, P::kAbdomen}};

Motion dressed(const Motion& source,
               const Skeleton& avatar,
               const std::optional<LiveHandsOptions>& hands) {
  LiveRetargetOptions options;
  options.hands = hands;
  auto live = LiveRetarget::make(source.skeleton, avatar, options);
  EXPECT_TRUE(live);
  Motion out{avatar, source.rate, 0, {}};
  for (const Pose& pose : source.poses) {
    live->step(pose, 1.0 / source.rate.hz, out.poses.emplace_back());
  }
  return out;
}

double live_gap_in(const Motion& motion, std::size_t t, const Scene& scene) {
  const BodyVolume volume = average_volume(motion.skeleton, mapped(motion.skeleton));
  return gap_m(volume,
               world_from_joints(motion.skeleton, motion.poses[t]),
               on_side(P::kLeftHand, scene.side),
               scene.part);
}

// A sixth of a second after the source's hand has come to rest, because of the lag.
TEST(LiveHands, TouchWhereTheSourceTouches) {
  double worst_without_m = 0.0;
  for (const Scene& scene : kScenes) {
    const Motion source = hands_go_to(scene.places());
    for (const Skeleton& avatar :
         {testing::child(), testing::giant(), testing::long_legs(), broad(1.4)}) {
      const Motion with = dressed(source, avatar, LiveHandsOptions{});
      const Motion without = dressed(source, avatar, std::nullopt);
      for (std::size_t t = kHeldFirst + 10; t <= kHeldLast; t += 10) {
        const double truth_m = live_gap_in(source, t, scene);
        const double off_m = std::abs(live_gap_in(with, t, scene) - truth_m);
        worst_without_m =
            std::max(worst_without_m, std::abs(live_gap_in(without, t, scene) - truth_m));
        EXPECT_LT(off_m, 0.01) << scene.name << " " << t << " "
                               << mapped(avatar).leg_length_m;
      }
    }
  }
  EXPECT_GT(worst_without_m, 0.08) << "the claim is empty";
}

// Returns the depth of forearms in the trunk, skin in skin; while held, or over the
// motion. [m]
double max_depth_m(const Motion& motion, const BodyVolume& volume, bool held = false) {
  double deepest = 0.0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    if (held && (t < kHeldFirst + 10 || t > kHeldLast)) continue;
    const Pose& pose = motion.poses[t];
    const auto world = world_from_joints(motion.skeleton, pose);
    for (int side = 0; side < 2; ++side) {
      const Capsule& arm = *volume[on_side(P::kLeftForearm, side)];
      for (const double along : {-1.0, 0.0, 1.0}) {
        const glm::dvec3 p = world[index(arm.joint)] * axis_point_in_joint(arm, along);
        for (const P part : {P::kChest, P::kAbdomen, P::kPelvis}) {
          const double gap = side_of(*volume[part], world, p).distance_m - arm.radius_m;
          deepest = std::max(deepest, -gap);
        }
      }
    }
  }
  return deepest;
}

// During fast movements they lag, by the effect of 25 ms applied twice.
TEST(LiveHands, KeepArmsOutOfABiggerBelly) {
  const Skeleton body = adult();
  LiveHandsOptions options;
  options.avatar_volume = with_belly(average_volume(body, mapped(body)), 1.5);
  for (const auto& places : {hands_on_hips(), hand_on_belly(), clapping()}) {
    const Motion source = hands_go_to(places);
    const Motion with = dressed(source, body, options);
    const Motion without = dressed(source, body, std::nullopt);
    const double own_m = max_depth_m(source, average_volume(body, mapped(body)), true);
    EXPECT_LT(max_depth_m(with, *options.avatar_volume, true), own_m + 0.005);
    EXPECT_LT(max_depth_m(with, *options.avatar_volume), 0.03);
    EXPECT_GT(max_depth_m(without, *options.avatar_volume), 0.028)
        << "the claim is empty";
  }
}

// A hand that descends fast lags, as above.
TEST(LiveHands, StayOverTheFloor) {
  const Motion source = hands_go_to(hands_on_hips());
  Motion with = dressed(source, ape(), LiveHandsOptions{});
  EXPECT_GT(deepest_hand_m(dressed(source, ape(), std::nullopt)), 0.08)
      << "the claim is empty";
  EXPECT_LT(deepest_hand_m(with), 0.05);
  // They hang from frame 180 on.
  with.poses.erase(with.poses.begin(), with.poses.begin() + 200);
  EXPECT_LT(deepest_hand_m(with), 0.005);
}

TEST(LiveHands, LeaveTheSourcesOwnBodyAsItIs) {
  for (const Scene& scene : kScenes) {
    const Motion source = hands_go_to(scene.places());
    const Motion with = dressed(source, source.skeleton, LiveHandsOptions{});
    const Motion without = dressed(source, source.skeleton, std::nullopt);
    for (const B bone : {B::kLeftHand, B::kRightHand, B::kLeftLowerArm}) {
      const auto a = joint_path(with, bone);
      const auto b = joint_path(without, bone);
      for (std::size_t t = 0; t < a.size(); ++t) {
        EXPECT_LT(glm::distance(a[t], b[t]), 1e-9) << scene.name << " " << t;
      }
    }
  }
}

// The displacement of a hand is nearly as smooth as that of refine_hands(), which uses
// future frames and has a bound of five sevenths of this. Elbows that are bent far move
// faster than their hands, on the source's own path too.
TEST(LiveHands, MoveContinuously) {
  for (const Scene& scene : kScenes) {
    const Motion source = hands_go_to(scene.places());
    for (const Skeleton& avatar : {testing::child(), testing::giant(), broad(1.4)}) {
      const Motion with = dressed(source, avatar, LiveHandsOptions{});
      const Motion without = dressed(source, avatar, std::nullopt);
      for (const B bone : {B::kLeftHand, B::kRightHand, B::kLeftLowerArm}) {
        const auto a = joint_path(without, bone);
        const auto b = joint_path(with, bone);
        const double hz2 = source.rate.hz * source.rate.hz;
        double added = 0.0;
        double own = 0.0;
        double distance_m = 0.0;
        for (std::size_t t = 1; t + 1 < a.size(); ++t) {
          const auto d = [&](std::size_t i) { return b[i] - a[i]; };
          added = std::max(added, hz2 * glm::length(d(t - 1) - 2.0 * d(t) + d(t + 1)));
          own = std::max(own, hz2 * glm::length(a[t - 1] - 2.0 * a[t] + a[t + 1]));
          distance_m = std::max(distance_m, glm::length(d(t)));
        }
        const double offline = 2.0 * 5.8 * distance_m / 0.09 + 5.0;
        EXPECT_LT(added, bone == B::kLeftLowerArm ? own : 1.4 * offline)
            << scene.name << " " << name(bone) << " " << distance_m;
      }
    }
  }
}

}  // namespace
}  // namespace marey::retarget
