// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamics/push/force_push.h"
#include <gtest/gtest.h>

#include "tests/dynamics/push/made_push.h"

namespace marey::dynamics {
namespace {

double largest_distance_m(const ForcePush& a, const ForcePush& b) {
  double out = 0.0;
  for (int i = 0; i <= 50; ++i) {
    const double x = i / 50.0;
    out = std::max(
        out, std::abs(a.height_m(x * a.duration_s()) - b.height_m(x * b.duration_s())));
  }
  return out;
}

/// Ends for a rise of the flight after the push.
PushEnds ends_with_rise(const MadePush& made, double rise_m) {
  PushEnds out = made.ends;
  out.end_m_s = std::sqrt(2.0 * kStandardGravity_m_s2 * rise_m);
  return out;
}

TEST(ForcePushProperties, OneMillimetreOfApexMovesNoInstantByThree) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const MadePush made = made_push(seed);
    const double own_m =
        made.ends.end_m_s * made.ends.end_m_s / (2.0 * kStandardGravity_m_s2);
    for (double ratio = 0.5; ratio < 2.0; ratio += 0.05) {
      const auto before =
          derive_push(made.reference, ends_with_rise(made, own_m * ratio));
      const auto after =
          derive_push(made.reference, ends_with_rise(made, own_m * ratio + 1e-3));
      if (!before || !after) continue;
      EXPECT_LT(largest_distance_m(*before, *after), 3e-3) << seed << " " << ratio;
    }
  }
}

TEST(ForcePushProperties, AWishFromLowestToHighestPossibleGivesAContinuousCurve) {
  // 1 mm of apex at a take-off of 2.45 m/s is 0.004 m/s.
  for (unsigned seed = 0; seed < 20; ++seed) {
    const MadePush made = made_push(seed);
    PushEnds ends = made.ends;
    std::optional<ForcePush> before;
    int derived = 0;
    for (double speed_m_s = 0.1; speed_m_s < 7.0; speed_m_s += 0.004) {
      ends.end_m_s = speed_m_s;
      const auto now = derive_push(made.reference, ends);
      if (before && now) {
        EXPECT_LT(largest_distance_m(*before, *now), 3e-3) << seed << " " << speed_m_s;
      }
      derived += now ? 1 : 0;
      before = now;
    }
    EXPECT_GT(derived, 1000) << seed;
  }
}

TEST(ForcePushProperties, MetresAndSecondsScaleTogether) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const MadePush made = made_push(seed);
    const PushEnds ends = changed_ends(made, seed);
    const auto push = derive_push(made.reference, ends);
    if (!push) continue;
    for (const double k : {0.35, 1.7}) {  // z k, T sqrt k, the same g and forces.
      const double root = std::sqrt(k);
      const PushReference reference = make_push_reference(
          made.reference.duration_s * root, made.reference.force_m_s2);
      PushEnds scaled{ends.start_m * k,
                      ends.start_m_s * root,
                      ends.end_m * k,
                      ends.end_m_s * root,
                      ends.duration_s * root};
      const auto other = derive_push(reference, scaled);
      ASSERT_TRUE(other) << seed;
      for (int i = 0; i <= 50; ++i) {
        const double t_s = ends.duration_s * i / 50.0;
        const double u_s = std::min(t_s * root, scaled.duration_s);
        EXPECT_NEAR(other->force_m_s2(u_s), push->force_m_s2(t_s), 1e-4) << seed;
        EXPECT_NEAR(other->height_m(u_s), k * push->height_m(t_s), 1e-7) << seed;
      }
    }
  }
}

TEST(ForcePushProperties, GravityAndForcesScaleTogether) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const MadePush made = made_push(seed);
    const PushEnds ends = changed_ends(made, seed);
    const auto push = derive_push(made.reference, ends);
    if (!push) continue;
    constexpr double kFactor = 2.25;  // g and forces k, T / sqrt k, the same heights.
    PushEnds scaled = ends;
    scaled.gravity_m_s2 *= kFactor;
    scaled.start_m_s *= 1.5;
    scaled.end_m_s *= 1.5;
    scaled.duration_s /= 1.5;
    const auto other = derive_push(made.reference, scaled, {}, {.scale = kFactor});
    ASSERT_TRUE(other) << seed;
    for (int i = 0; i <= 50; ++i) {
      EXPECT_NEAR(other->height_m(scaled.duration_s * i / 50.0),
                  push->height_m(ends.duration_s * i / 50.0),
                  1e-7)
          << seed;
    }
  }
}

TEST(ForcePushProperties, AHigherStartMovesTheWholePush) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const MadePush made = made_push(seed);
    PushEnds ends = changed_ends(made, seed);
    const auto push = derive_push(made.reference, ends);
    ends.start_m += 2.0;
    ends.end_m += 2.0;
    const auto higher = derive_push(made.reference, ends);
    ASSERT_EQ(push.has_value(), higher.has_value()) << seed;
    if (!push) continue;
    for (int i = 0; i <= 50; ++i) {
      const double t_s = ends.duration_s * i / 50.0;
      EXPECT_NEAR(higher->height_m(t_s), push->height_m(t_s) + 2.0, 1e-9) << seed;
    }
  }
}

TEST(ForcePushProperties, HigherJumpsSquatDeeperInTheSameTime) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const MadePush made = made_push(seed);
    const double own_m =
        made.ends.end_m_s * made.ends.end_m_s / (2.0 * kStandardGravity_m_s2);
    double before_m = 1e9;
    for (const double ratio : {0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0}) {
      const auto push = derive_push(made.reference, ends_with_rise(made, own_m * ratio));
      ASSERT_TRUE(push) << seed << " " << ratio;
      double lowest_m = 1e9;
      for (int i = 0; i <= 500; ++i) {
        lowest_m = std::min(lowest_m, push->height_m(push->duration_s() * i / 500.0));
      }
      EXPECT_LE(lowest_m, before_m + 1e-9) << seed << " " << ratio;
      before_m = lowest_m;
    }
  }
}

TEST(ForcePushProperties, TheSameInputGivesTheSameBits) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const MadePush made = made_push(seed);
    const PushEnds ends = changed_ends(made, seed);
    const auto a = derive_push(made.reference, ends);
    const auto b = derive_push(made.reference, ends);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(a->correction_m_s2(), b->correction_m_s2());
  }
}

}  // namespace
}  // namespace marey::dynamics
