// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "core/base/smooth_step.h"
#include "retarget/feet/plan_foot_path.h"

namespace marey::retarget {
namespace {

constexpr FrameRate kRate{60.0};
const FootMap kFoot{0.08, 0.02, {0, -0.06, 0.13}, true};

double yaw_of(const glm::dquat& foot) {
  const glm::dvec3 ahead = foot * glm::dvec3(0, 0, 1);
  return std::atan2(ahead.x, ahead.z);
}

double apart(double a, double b) {
  return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi));
}

glm::dvec3 ball_of(const FootPlace& place) {
  return place.ankle_in_world + place.foot * kFoot.ball_from_ankle_in_t_pose;
}

/// A foot that stands for two seconds and rotates by `turn_rad` in the middle one, about
/// a point between ankle (0) and ball (1).
struct TurningFoot {
  std::vector<FootPlace> reference;
  FootContacts contacts;

  TurningFoot(double turn_rad, double pivot) {
    const glm::dvec3 way = pivot * glm::dvec3(0, 0, 0.13);
    for (int t = 0; t < 120; ++t) {
      const double turned = turn_rad * smooth_step((t - 30) / 60.0);
      FootPlace place;
      place.foot = glm::angleAxis(turned, glm::dvec3(0, 1, 0));
      place.toes = place.foot;
      place.ankle_in_world = glm::dvec3(0.2, 0.08, 0.1) + way - place.foot * way;
      reference.push_back(place);
    }
    contacts.heel = contacts.ball = contacts.stance = {{0, 119}};
  }
  [[nodiscard]] std::vector<FootPlace> plan() const {
    return plan_foot_path(reference, contacts, kFoot, 0.85, kRate);
  }
};

// A turn on the spot: the foot rotates, the ball stays.
TEST(Footprint, TurnsWithAFootThatPivotsOnItsBall) {
  for (const double turn_deg : {40.0, 120.0, -170.0, 400.0}) {
    const TurningFoot foot(turn_deg * kRadiansPerDegree, 1.0);
    const auto plan = foot.plan();
    for (std::size_t t = 0; t < plan.size(); ++t) {
      EXPECT_LT(apart(yaw_of(plan[t].foot), yaw_of(foot.reference[t].foot)),
                5.0 * kRadiansPerDegree)
          << turn_deg << ", frame " << t;
      EXPECT_LT(apart(yaw_of(plan[t].toes), yaw_of(foot.reference[t].foot)),
                5.0 * kRadiansPerDegree);
      EXPECT_LT(glm::distance(ball_of(plan[t]), ball_of(plan[0])), 1e-3);
      EXPECT_LT(glm::distance(ball_of(plan[t]), ball_of(foot.reference[t])), 0.01);
      EXPECT_LT(std::abs((plan[t].foot * glm::dvec3(0, 1, 0)).y - 1.0), 1e-12);
    }
  }
}

TEST(Footprint, TurnsAboutTheHeelWhereThatStays) {
  const TurningFoot foot(90.0 * kRadiansPerDegree, 0.0);
  const auto plan = foot.plan();
  for (std::size_t t = 0; t < plan.size(); ++t) {
    EXPECT_LT(apart(yaw_of(plan[t].foot), yaw_of(foot.reference[t].foot)),
              5.0 * kRadiansPerDegree);
    EXPECT_LT(glm::distance(plan[t].ankle_in_world, plan[0].ankle_in_world), 0.01);
  }
}

// On the ball alone the foot, heel up, rotates about it; its flat positions before and
// after follow from the ball.
TEST(Footprint, TurnsAboutTheBallThatBearsAlone) {
  TurningFoot foot(150.0 * kRadiansPerDegree, 1.0);
  for (std::size_t t = 25; t < 95; ++t) {
    FootPlace& place = foot.reference[t];
    const glm::dvec3 ball = ball_of(place);
    const double up = 0.5 * smooth_step((static_cast<double>(t) - 25.0) / 10.0) *
                      smooth_step((94.0 - static_cast<double>(t)) / 10.0);
    place.foot = place.foot * glm::angleAxis(up, glm::dvec3(1, 0, 0));
    place.ankle_in_world = ball - place.foot * kFoot.ball_from_ankle_in_t_pose;
  }
  foot.contacts.heel = {{0, 24}, {95, 119}};
  const auto plan = foot.plan();
  for (std::size_t t = 0; t < plan.size(); ++t) {
    // The foot leaves its footprint, up to 5 degrees behind, with no jump of speed.
    EXPECT_LT(apart(yaw_of(plan[t].foot), yaw_of(foot.reference[t].foot)),
              7.0 * kRadiansPerDegree)
        << t;
    EXPECT_LT(glm::distance(ball_of(plan[t]), ball_of(plan[0])), 1e-3) << t;
  }
}

TEST(Footprint, StaysConstantForAWaveringFoot) {
  TurningFoot foot(0.0, 1.0);
  for (std::size_t t = 0; t < foot.reference.size(); ++t) {
    foot.reference[t].foot = glm::angleAxis(0.04 * std::sin(0.3 * static_cast<double>(t)),
                                            glm::dvec3(0, 1, 0));
  }
  const auto plan = foot.plan();
  for (const FootPlace& place : plan) {
    EXPECT_EQ(place.ankle_in_world, plan[0].ankle_in_world);
    EXPECT_LT(apart(yaw_of(place.foot), yaw_of(plan[0].foot)), 1e-9);
  }
}

// No visible kink.
TEST(Footprint, TurnsSmoothly) {
  const TurningFoot foot(120.0 * kRadiansPerDegree, 1.0);
  const auto plan = foot.plan();
  const auto fastest = [](const std::vector<FootPlace>& places) {
    double maximum = 0.0;
    for (std::size_t t = 1; t < places.size(); ++t) {
      maximum =
          std::max(maximum, apart(yaw_of(places[t].foot), yaw_of(places[t - 1].foot)));
    }
    return maximum;
  };
  EXPECT_LT(fastest(plan), 1.1 * fastest(foot.reference));
}

}  // namespace
}  // namespace marey::retarget
