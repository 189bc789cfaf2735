// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/throw_course.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/models/made_reach.h"

namespace marey::engine {
namespace {

using testing::MadeHand;
using testing::random_between;

constexpr double kThrowStep_s = 1.0 / 240.0;
constexpr double kCapturedRelease_s = 0.8003;

// A thrower whose hips walk and turn.
struct MadeThrow {
  MadeHand hand;
  double turns_rad_s = 0.0;
  glm::dvec3 lever{0.02, 0.06, 0.03};

  explicit MadeThrow(std::mt19937& random)
      : hand(random), turns_rad_s(random_between(random, -2.0, 2.0)) {}

  [[nodiscard]] RootPlace root(double time_s) const {
    return {0.3 + 0.8 * time_s, -0.2 + 0.5 * time_s, 0.4 + turns_rad_s * time_s};
  }
  [[nodiscard]] ThrowInstant at(double time_s) const {
    return {hand.at(time_s), root(time_s), lever};
  }
  [[nodiscard]] ThrowParameters captured() const {
    return measure_throw(at(kCapturedRelease_s), kCapturedRelease_s);
  }
};

struct PlayedThrow {
  std::vector<glm::dvec3> wrist;  // At i * kThrowStep_s.
  BallRelease release;
  int released = 0;
};

PlayedThrow play_throw(const MadeThrow& made, const ThrowChanges& wish, double step_s) {
  const double release_s = wish.release_s.value_or(kCapturedRelease_s);
  ThrowCourse course;
  course.start(0.0, made.captured(), wish);
  PlayedThrow played;
  played.wrist.push_back(made.hand.at(0.0).p_in_world);
  for (int i = 1; i * step_s < 1.6; ++i) {
    ThrowInput input;
    input.time_s = i * step_s;
    input.step_s = step_s;
    input.clip_now = made.hand.at(input.time_s);
    input.clip_at_release = made.at(release_s);
    input.release_s = release_s;
    const ThrowOutput output = course.step(input);
    played.wrist.push_back(output.wrist.p_in_world);
    if (output.release) {
      played.release = *output.release;
      ++played.released;
    }
  }
  return played;
}

// The seven parameters from the places of the wrist and the rotations of the clip's hand,
// by differences: independent of the course.
ThrowParameters judge_throw(const MadeThrow& made,
                            const std::vector<glm::dvec3>& wrist,
                            double step_s,
                            double release_s) {
  testing::JudgedWay way{0.0, step_s, wrist};
  const std::size_t last = way.before(release_s);
  const double e = 1e-4;
  const glm::dvec3 lever_now = made.hand.frame(release_s).rotation * made.lever;
  const glm::dvec3 lever_rate = (made.hand.frame(release_s + e).rotation * made.lever -
                                 made.hand.frame(release_s - e).rotation * made.lever) /
                                (2.0 * e);
  (void)lever_now;
  const glm::dvec3 velocity = way.velocity_before(release_s) + lever_rate;
  const RootPlace root = made.root(release_s);
  const glm::dvec3 across(std::cos(root.heading_rad), 0.0, -std::sin(root.heading_rad));
  const glm::dvec3 ahead(std::sin(root.heading_rad), 0.0, std::cos(root.heading_rad));
  const glm::dvec3 from_hips =
      way.place(release_s, last) - glm::dvec3(root.x_m, 0.0, root.z_m);
  ThrowParameters judged;
  judged.wrist_in_heading_m = {
      glm::dot(from_hips, across), from_hips.y, glm::dot(from_hips, ahead)};
  judged.speed_m_s = glm::length(velocity);
  judged.azimuth_rad = std::atan2(glm::dot(velocity, across), glm::dot(velocity, ahead));
  judged.elevation_rad = std::asin(velocity.y / judged.speed_m_s);
  judged.release_s = release_s;
  return judged;
}

void expect_throw(const ThrowParameters& judged, const ThrowParameters& asked) {
  EXPECT_LT(glm::distance(judged.wrist_in_heading_m, asked.wrist_in_heading_m), 1e-3);
  EXPECT_LT(
      std::abs(std::remainder(judged.azimuth_rad - asked.azimuth_rad, 6.283185307)) *
          std::cos(asked.elevation_rad),
      0.1 / 57.3);
  EXPECT_NEAR(judged.elevation_rad, asked.elevation_rad, 0.1 / 57.3);
  EXPECT_NEAR(judged.speed_m_s, asked.speed_m_s, 0.005 * asked.speed_m_s);
}

ThrowChanges wish_for(const ThrowParameters& captured, int parameter, double by) {
  ThrowChanges wish;
  switch (parameter) {
    case 0:
      wish.x_m = captured.wrist_in_heading_m.x + 0.2 * by;
      break;
    case 1:
      wish.y_m = captured.wrist_in_heading_m.y + 0.2 * by;
      break;
    case 2:
      wish.z_m = captured.wrist_in_heading_m.z + 0.2 * by;
      break;
    case 3:
      wish.azimuth_rad = captured.azimuth_rad + 0.4 * by;
      break;
    case 4:
      wish.elevation_rad = std::clamp(captured.elevation_rad + 0.3 * by, -1.5, 1.5);
      break;
    case 5:
      wish.speed_m_s = captured.speed_m_s * (1.0 + 0.4 * by);
      break;
    default:
      wish.release_s = captured.release_s + 0.1 * by;
      break;
  }
  return wish;
}

TEST(ThrowCourse, SevenParametersTimesNineValuesChangeOneAtATime) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    const MadeThrow made(random);
    const ThrowParameters captured = made.captured();
    for (int parameter = 0; parameter < 7; ++parameter) {
      for (int value = -4; value <= 4; ++value) {
        SCOPED_TRACE(::testing::Message() << seed << ' ' << parameter << ' ' << value);
        const ThrowChanges wish = wish_for(captured, parameter, value / 4.0);
        ASSERT_TRUE(check_throw(wish, 1.6));
        const PlayedThrow played = play_throw(made, wish, kThrowStep_s);
        ASSERT_EQ(played.released, 1);
        const ThrowParameters asked = with_changes(captured, wish);
        EXPECT_NEAR(played.release.time_s, asked.release_s, 1e-9);
        expect_throw(judge_throw(made, played.wrist, kThrowStep_s, asked.release_s),
                     asked);
        // The ball's own record, too.
        EXPECT_NEAR(glm::length(played.release.velocity_m_s), asked.speed_m_s, 1e-9);
      }
    }
  }
}

TEST(ThrowCourse, IsZeroOutsideOfItsWidthAndHasTwoDerivatives) {
  std::mt19937 random(20);
  const MadeThrow made(random);
  ThrowChanges wish;
  wish.speed_m_s = 1.5 * made.captured().speed_m_s;
  wish.y_m = made.captured().wrist_in_heading_m.y + 0.1;
  const double fine_s = 1.0 / 1920;
  const PlayedThrow played = play_throw(made, wish, kThrowStep_s);
  const PlayedThrow fine = play_throw(made, wish, fine_s);
  for (std::size_t i = 0; i < played.wrist.size(); ++i) {
    const double time_s = static_cast<double>(i) * kThrowStep_s;
    if (std::abs(time_s - kCapturedRelease_s) < 0.35) continue;
    EXPECT_EQ(played.wrist[i], made.hand.at(time_s).p_in_world);
  }
  const testing::JudgedWay coarse_way{0.0, kThrowStep_s, played.wrist};
  const testing::JudgedWay fine_way{0.0, fine_s, fine.wrist};
  EXPECT_LT(fine_way.max_jump(), 0.3 * coarse_way.max_jump());
}

TEST(ThrowCourse, WithoutWishIsTheClipToTheBit) {
  std::mt19937 random(21);
  const MadeThrow made(random);
  const PlayedThrow played = play_throw(made, {}, kThrowStep_s);
  ASSERT_EQ(played.released, 1);
  for (std::size_t i = 0; i < played.wrist.size(); ++i) {
    EXPECT_EQ(played.wrist[i],
              made.hand.at(static_cast<double>(i) * kThrowStep_s).p_in_world);
  }
  EXPECT_EQ(played.release.velocity_m_s, ball_velocity_m_s(made.at(kCapturedRelease_s)));
}

TEST(ThrowCourse, WrongWishesAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ThrowChanges wish;
  wish.speed_m_s = 0.0;
  ASSERT_FALSE(check_throw(wish, 2.0));
  EXPECT_NE(check_throw(wish, 2.0).error().message().find("speed_m_s"),
            std::string::npos);
  wish = {};
  wish.elevation_rad = 2.0;
  EXPECT_FALSE(check_throw(wish, 2.0));
  wish = {};
  wish.z_m = nan;
  EXPECT_FALSE(check_throw(wish, 2.0));
  wish = {};
  wish.release_s = 2.1;
  EXPECT_FALSE(check_throw(wish, 2.0));
}

}  // namespace
}  // namespace marey::engine
