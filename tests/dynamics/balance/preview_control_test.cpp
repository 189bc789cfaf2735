// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/preview_control.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::dynamics {
namespace {

// Kajita et al. 2003: 5 ms, 0.814 m, jerk weight 1e-6.
constexpr FrameRate kKajitaRate{200.0};
constexpr double kKajitaHeight_m = 0.814;

std::vector<glm::dvec2> steps_to_the_sides() {
  std::vector<glm::dvec2> out;
  for (int t = 0; t < 1600; ++t) {
    const int step = std::clamp((t - 300) / 160, 0, 6);
    out.emplace_back(t < 300 ? 0.0 : 0.3 * step,
                     t < 300 || step == 6 ? 0.0 : (step % 2 == 0 ? 0.1 : -0.1));
  }
  return out;
}

struct Followed {
  std::vector<glm::dvec2> zmp;
  std::vector<glm::dvec2> com;
};

Followed follow(PreviewControl& control, const std::vector<glm::dvec2>& wanted) {
  control.reset(wanted.front());
  Followed out;
  for (std::size_t t = 0; t < wanted.size(); ++t) {
    out.zmp.push_back(control.zmp_xz_m());
    out.com.push_back(control.com_xz_m());
    control.step(std::span(wanted).subspan(t));
  }
  return out;
}

TEST(PreviewControl, AStandingReferenceIsKept) {
  PreviewControl control(kKajitaRate, kKajitaHeight_m);
  const std::vector<glm::dvec2> wanted(400, glm::dvec2(0.3, -0.2));
  for (const glm::dvec2& p : follow(control, wanted).com) {
    EXPECT_LT(glm::distance(p, wanted.front()), 1e-6);
  }
}

TEST(PreviewControl, ThePreviewFadesWithinAboutASecond) {
  PreviewOptions options;
  options.preview_s = 2.0;
  const PreviewGains gains = preview_gains(kKajitaRate, kKajitaHeight_m, options);
  double largest = 0.0;
  for (const double one : gains.of_preview) largest = std::max(largest, std::abs(one));
  // The published curve of gains is near zero after 1.5 s.
  for (std::size_t i = 300; i + 1 < gains.of_preview.size(); ++i) {
    EXPECT_LT(std::abs(gains.of_preview[i]), 0.02 * largest) << i;
  }

  // All gains together hold a body at rest over the point.
  double sum = gains.of_state[0];
  for (const double one : gains.of_preview) sum += one;
  EXPECT_LT(std::abs(sum), 1e-9 * gains.of_state[0]);
}

// Returns the largest error away from steps.
double worst_error_m(double preview_s) {
  PreviewOptions options;
  options.preview_s = preview_s;
  PreviewControl control(kKajitaRate, kKajitaHeight_m, options);
  EXPECT_EQ(control.preview_frames(),
            static_cast<std::size_t>(std::lround(preview_s * kKajitaRate.hz)));
  const auto wanted = steps_to_the_sides();
  const Followed out = follow(control, wanted);
  double worst_m = 0.0;
  for (std::size_t t = 0; t < wanted.size(); ++t) {
    const bool is_near_step = t + 45 >= 300 && t < 1450 && ((t + 45 - 300) % 160) < 90;
    if (!is_near_step) worst_m = std::max(worst_m, glm::distance(out.zmp[t], wanted[t]));
  }
  EXPECT_LT(glm::distance(out.com.back(), wanted.back()), 2e-3);
  return worst_m;
}

TEST(PreviewControl, TheZeroMomentPointFollowsSteps) {
  EXPECT_LT(worst_error_m(1.6), 0.025);
}

TEST(PreviewControl, AShortPreviewFollowsLessWellAsPublished) {
  const double long_m = worst_error_m(1.6);
  const double short_m = worst_error_m(0.8);
  EXPECT_GT(short_m, long_m);
  EXPECT_LT(short_m, 0.04);
}

TEST(PreviewControl, TheCentreMovesBeforeTheStep) {
  PreviewControl control(kKajitaRate, kKajitaHeight_m);
  std::vector<glm::dvec2> wanted(800, glm::dvec2(0.0));
  std::fill(wanted.begin() + 400, wanted.end(), glm::dvec2(0.3, 0.0));
  const Followed out = follow(control, wanted);
  EXPECT_NEAR(out.com[200].x, 0.0, 1e-3);
  EXPECT_GT(out.com[400].x, 0.1);
  EXPECT_NEAR(out.com.back().x, 0.3, 1e-2);
}

TEST(PreviewControl, TheGainsAreAFixedPointAtUsualRates) {
  for (const double hz : {30.0, 60.0, 120.0, 240.0}) {
    for (const double height_m : {0.35, 0.9, 1.4}) {
      PreviewControl control(FrameRate{hz}, height_m);
      const std::vector<glm::dvec2> wanted(static_cast<std::size_t>(6 * hz),
                                           glm::dvec2(0.1, 0.0));
      control.reset({0.0, 0.0});
      for (std::size_t t = 0; t < wanted.size(); ++t) {
        control.step(std::span(wanted).subspan(t));
      }
      EXPECT_LT(glm::distance(control.com_xz_m(), glm::dvec2(0.1, 0.0)), 2e-3) << hz;
    }
  }
}

TEST(PreviewControl, EqualInputsGiveEqualBits) {
  PreviewControl a(kKajitaRate, kKajitaHeight_m);
  PreviewControl b(kKajitaRate, kKajitaHeight_m);
  const auto wanted = steps_to_the_sides();
  EXPECT_EQ(follow(a, wanted).com, follow(b, wanted).com);
}

TEST(PreviewControl, AStreamMovesItsPointAfterTheDelay) {
  PreviewBalance balance(kKajitaRate, kKajitaHeight_m);
  PreviewBalance again(kKajitaRate, kKajitaHeight_m);
  const std::size_t delay = balance.latency_frames();
  EXPECT_EQ(delay, 160U);
  // The point is wanted 5 cm to the side from frame 400 on.
  std::vector<glm::dvec2> shifts;
  for (std::size_t t = 0; t < 1200; ++t) {
    const glm::dvec2 wanted(0.0, t >= 400 ? 0.05 : 0.0);
    shifts.push_back(balance.step(wanted));
    EXPECT_EQ(again.step(wanted), shifts.back());
  }
  for (std::size_t t = 0; t < delay; ++t) EXPECT_EQ(shifts[t], glm::dvec2(0.0));
  // The displacement of frame t comes out `delay` frames later.
  EXPECT_LT(std::abs(shifts[350].y), 1e-9);
  EXPECT_GT(shifts[400 + delay].y, 0.01);
  EXPECT_NEAR(shifts.back().y, 0.05, 1e-3);
  const auto point = [&](std::size_t t) {
    const double hz = kKajitaRate.hz;
    const double bend = (shifts[t + 1].y - 2.0 * shifts[t].y + shifts[t - 1].y) * hz * hz;
    return shifts[t].y - kKajitaHeight_m / kStandardGravity_m_s2 * bend;
  };
  for (std::size_t t = 420 + delay; t + 1 < shifts.size(); ++t) {
    EXPECT_NEAR(point(t), 0.05, 0.01) << t;
  }
}

}  // namespace
}  // namespace marey::dynamics
