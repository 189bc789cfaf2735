// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_zmp.h"

#include <cstddef>
#include <vector>

#include "edit/balance/zmp_track.h"
#include <gtest/gtest.h>

#include "retarget/adapt/adapter.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/zmp_judge.h"

namespace marey::app {
namespace {

TEST(AdaptZmp, AlmostAllZeroMomentPointsOfAWalkAreInside) {
  const auto body = make_adapt_body(testing::synthetic_walk(150, 60.0).motion, {});
  ASSERT_TRUE(body) << body.error().message();
  const auto supports =
      retarget::plan_supports(body->reference, body->map, body->contacts, {});
  const edit::ZmpGround ground =
      edit::zmp_ground(body->reference, body->map, body->contacts);
  const auto outside = [&](const Motion& motion) {
    int out = 0;
    for (const testing::JudgedZmp& one :
         testing::judge_zmp(motion,
                            testing::judged_feet(body->map),
                            body->character.masses,
                            ground.loaded,
                            ground.floor_height_m)) {
      if (one.vertical_force_g >= 0.2 && one.outside_m && *one.outside_m > 1e-6) ++out;
    }
    return out;
  };
  ASSERT_GT(outside(body->reference), 60);
  retarget::AdaptMotionOptions options;
  options.adapt.balance = retarget::BalanceMode::kZmp;
  const auto made = adapt_with_zmp(*body, {}, supports, options);
  ASSERT_TRUE(made) << made.error().message();
  EXPECT_LE(outside(made->adapted.motion), 2);
  EXPECT_EQ(made->figures.supported_frames - made->figures.inside_frames,
            outside(made->adapted.motion));
  for (const retarget::KeptConstraint& foot : made->adapted.supports) {
    EXPECT_LT(foot.worst_error_m, 1e-3) << foot.id;
  }
}

TEST(AdaptZmp, SinglePosturesAreRefusedByName) {
  const auto body = make_adapt_body(testing::synthetic_walk(30, 60.0).motion, {});
  ASSERT_TRUE(body);
  retarget::AdaptOptions options;
  options.balance = retarget::BalanceMode::kZmp;
  const auto made = retarget::Adapter::make(body->character, {}, options);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message().find("zero moment point"), std::string::npos);
}

}  // namespace
}  // namespace marey::app
