// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/lead_legs.h"

#include <cmath>
#include <random>

#include "engine/feet/leg_reach.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"

namespace marey::engine {
namespace {

double angle_between_rad(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat q = b * glm::conjugate(a);
  return 2.0 * std::asin(std::min(1.0, std::hypot(q.x, std::hypot(q.y, q.z))));
}

struct LedBody {
  std::shared_ptr<const MotionBase> base = made_base();
  Rig rig = make_rig(made_skeleton(), *retarget::map_body(made_skeleton()));

  [[nodiscard]] BlendPosture posture_at(double time_s) const {
    BlendPosture out;
    sample_clip(base->clip(*base->find("walk")), time_s, out);
    return out;
  }
};

TEST(LeadLegs, BringsFeetToTheirPlacesWithinReach) {
  const LedBody body;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> by(-0.1, 0.1);
  for (int i = 0; i < 200; ++i) {
    BlendPosture posture = body.posture_at(0.005 * i);
    const RootPlace root{0.4, -1.0, 0.05 * i};
    std::array<LedFoot, 2> feet = feet_of_posture(body.rig, root, posture);
    for (LedFoot& foot : feet) {
      foot.ankle_in_world += glm::dvec3(by(random), 0.5 * by(random), by(random));
      foot.world_from_t_pose =
          glm::angleAxis(2.0 * by(random), glm::dvec3(0, 1, 0)) * foot.world_from_t_pose;
    }
    lead_legs(body.rig, root, 1.0, feet, posture);
    const auto led = feet_of_posture(body.rig, root, posture);
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_LT(glm::distance(led[side].ankle_in_world, feet[side].ankle_in_world), 1e-5);
      EXPECT_LT(
          angle_between_rad(led[side].world_from_t_pose, feet[side].world_from_t_pose),
          1e-5);
      EXPECT_LE(std::cos(posture.fold_rad[2 + side]), kMostReach + 1e-5);
    }
  }
}

TEST(LeadLegs, KeepsAPostureWhoseFeetAreInPlace) {
  const LedBody body;
  const BlendPosture before = body.posture_at(0.3);
  BlendPosture posture = before;
  const RootPlace root{1.0, 2.0, 0.7};
  auto feet = feet_of_posture(body.rig, root, posture);
  // Straight legs are bent a little.
  const double bends = std::cos(before.fold_rad[2]) > kFreeReach ||
                               std::cos(before.fold_rad[3]) > kFreeReach
                           ? 0.05
                           : 1e-5;
  lead_legs(body.rig, root, 1.0, feet, posture);
  for (std::size_t i = 0; i < kUsedRotations; ++i) {
    EXPECT_NEAR(posture.x[i], before.x[i], 1e-5) << i;
    EXPECT_NEAR(posture.w[i], before.w[i], 1e-5) << i;
  }
  EXPECT_NEAR(posture.fold_rad[2], before.fold_rad[2], bends);
  EXPECT_NEAR(posture.fold_rad[3], before.fold_rad[3], bends);
}

TEST(LeadLegs, LowersTheHipsByAtMostTheirLimit) {
  const LedBody body;
  const BlendPosture before = body.posture_at(0.3);
  BlendPosture posture = before;
  const RootPlace root;
  auto feet = feet_of_posture(body.rig, root, posture);
  for (LedFoot& foot : feet) {
    foot.ankle_in_world.y -= 0.5;
    foot.stands = 1.0;
  }
  lead_legs(body.rig, root, 1.0, feet, posture);
  const double drop_m = static_cast<double>(before.height_legs - posture.height_legs) *
                        body.rig.leg_length_m;
  EXPECT_GT(drop_m, 0.9 * kMostHipsDrop_m);
  EXPECT_LE(drop_m, kMostHipsDrop_m + 1e-6);
}

}  // namespace
}  // namespace marey::engine
