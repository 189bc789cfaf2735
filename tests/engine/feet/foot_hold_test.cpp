// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/foot_hold.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::engine {
namespace {

constexpr double kStep_s = 1.0 / 120.0;
constexpr double kLeg_m = 0.9;
constexpr double kLand_s = 0.5;
constexpr double kLeave_s = 1.1;

retarget::FootMap average_foot() {
  retarget::FootMap foot;
  foot.ankle_height_m = 0.08;
  foot.ball_height_m = 0.02;
  foot.ball_from_ankle_in_t_pose = {0.0, -0.06, 0.13};
  foot.has_toes = true;
  return foot;
}

// An ankle that flies forward, is at its height above the sole from the landing to the
// leaving, and slides at `slide_m_s` meanwhile.
glm::dvec3 ankle_at(double time_s, double slide_m_s) {
  const double before = std::max(kLand_s - time_s, 0.0);
  const double after = std::max(time_s - kLeave_s, 0.0);
  const double z = slide_m_s * time_s - 2.0 * before * before * 4.0 + 4.0 * after * after;
  return {0.1, 0.08 + 1.5 * before * before + 1.2 * after * after, z};
}

struct HeldFoot {
  std::vector<glm::dvec3> places;
  std::vector<glm::dvec3> references;
};

HeldFoot held_foot(double slide_m_s, bool expects) {
  FootHold hold;
  FootHoldOptions options;
  HeldFoot out;
  for (double t = 0.0; t < 1.8; t += kStep_s) {
    FootReference reference;
    reference.ankle_in_world = ankle_at(t, slide_m_s);
    const bool bears = t >= kLand_s && t < kLeave_s;
    reference.heel_bears = bears;
    reference.ball_bears = bears;
    if (expects && !bears && t < kLand_s && kLand_s - t < options.land_s) {
      reference.landing = FootReference::Landing{
          kLand_s - t, ankle_at(kLand_s, slide_m_s), {0.0, 0.0, slide_m_s}};
    }
    out.places.push_back(
        hold.step(reference, average_foot(), kLeg_m, kStep_s, options).ankle_in_world);
    out.references.push_back(reference.ankle_in_world);
  }
  return out;
}

std::size_t frame(double time_s) {
  return static_cast<std::size_t>(std::lround(time_s / kStep_s));
}

TEST(FootHold, StandsStillAsSoonAsAnExpectedLandingIsOver) {
  const HeldFoot foot = held_foot(0.2, true);
  const glm::dvec3 first = foot.places[frame(kLand_s + 0.08)];
  for (std::size_t i = frame(kLand_s + 0.08); i < frame(kLeave_s); ++i) {
    EXPECT_LT(glm::distance(foot.places[i], first), 1e-9) << i;
  }
  // The landing itself was prepared: the foot hardly moves after it.
  EXPECT_LT(glm::distance(foot.places[frame(kLand_s) + 1], first), 2e-3);
}

TEST(FootHold, BrakesAFootThatBearsUnexpectedly) {
  const HeldFoot foot = held_foot(0.4, false);
  const FootHoldOptions options;
  const std::size_t stopped = frame(kLand_s + options.brake_s) + 1;
  for (std::size_t i = stopped; i < frame(kLeave_s); ++i) {
    EXPECT_LT(glm::distance(foot.places[i], foot.places[stopped]), 1e-9) << i;
  }
}

TEST(FootHold, ReturnsToTheReferenceAfterItLeaves) {
  const HeldFoot foot = held_foot(0.2, true);
  const FootHoldOptions options;
  for (std::size_t i = frame(kLeave_s + options.release_s) + 2; i < foot.places.size();
       ++i) {
    EXPECT_LT(glm::distance(foot.places[i], foot.references[i]), 1e-9) << i;
  }
}

TEST(FootHold, MovesWithoutJumps) {
  const HeldFoot foot = held_foot(0.2, true);
  for (std::size_t i = 2; i < foot.places.size(); ++i) {
    const glm::dvec3 acceleration =
        (foot.places[i] - 2.0 * foot.places[i - 1] + foot.places[i - 2]) /
        (kStep_s * kStep_s);
    EXPECT_LT(glm::length(acceleration), 60.0) << i;  // The reference has 16.
  }
}

TEST(FootHold, ReleasesAFootThatWouldStayFarBehind) {
  FootHold hold;
  FootHoldOptions options;
  FootReference reference;
  reference.heel_bears = true;
  reference.ball_bears = true;
  for (double t = 0.0; t < 2.0; t += kStep_s) {
    reference.ankle_in_world = {0.0, 0.08, 0.5 * t};
    (void)hold.step(reference, average_foot(), kLeg_m, kStep_s, options);
    const bool is_far = 0.5 * t > options.slip_legs * kLeg_m + 0.02;
    if (is_far) {
      EXPECT_FALSE(hold.holds()) << t;
    }
  }
}

TEST(FootHold, TurnsARaisedHeelAboutTheBall) {
  FootHold hold;
  const retarget::FootMap foot = average_foot();
  FootReference reference;
  reference.ankle_in_world = {0.0, 0.08, 0.0};
  reference.heel_bears = true;
  reference.ball_bears = true;
  FootHold::Place place;
  for (int i = 0; i < 30; ++i) place = hold.step(reference, foot, kLeg_m, kStep_s, {});
  const glm::dvec3 ball =
      place.ankle_in_world + place.world_from_t_pose * foot.ball_from_ankle_in_t_pose;
  reference.heel_bears = false;
  for (int i = 0; i < 60; ++i) {
    reference.world_from_t_pose = glm::angleAxis(0.01 * i, glm::dvec3(1, 0, 0));
    reference.ankle_in_world =
        ball - reference.world_from_t_pose * foot.ball_from_ankle_in_t_pose;
    place = hold.step(reference, foot, kLeg_m, kStep_s, {});
    const glm::dvec3 now =
        place.ankle_in_world + place.world_from_t_pose * foot.ball_from_ankle_in_t_pose;
    EXPECT_LT(glm::distance(now, ball), 1e-6) << i;
  }
}

}  // namespace
}  // namespace marey::engine
