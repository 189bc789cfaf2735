// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/push_reach.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace marey::dynamics {
namespace {

constexpr int kPieces = 4000;

/// Decides by duality whether piecewise constant forces from 0 to `force_m_s2` on a dense
/// grid have the moments: they do unless a direction (a, b) separates the moments from
/// all of them. Returns the largest separation in m/s. Positive: no force has them.
double separation(const PushMoments& m, double duration_s, double force_m_s2) {
  double worst = -1e9;
  for (int d = 0; d < 1440; ++d) {
    const double a = std::cos(2.0 * M_PI * d / 1440);
    const double b = std::sin(2.0 * M_PI * d / 1440) / duration_s;
    // Integral of max(0, a + b s) over the remaining time s, on the grid.
    double support = 0.0;
    for (int i = 0; i < 200; ++i) {
      const double left_s = duration_s * (i + 0.5) / 200;
      support += std::max(0.0, a + b * left_s) * force_m_s2 * duration_s / 200;
    }
    worst = std::max(worst, a * m.impulse_m_s + b * m.first_moment_m - support);
  }
  return worst;
}

/// Finds the mixture of the earliest and the latest block of `force_m_s2` that has the
/// moments, by bisection on a dense grid. Returns the share of the earliest block.
/// nullopt: no mixture has them.
std::optional<double> share_of_early_block(const PushMoments& m,
                                           double duration_s,
                                           double force_m_s2) {
  const double length_s = m.impulse_m_s / force_m_s2;
  if (!(length_s >= 0.0 && length_s <= duration_s)) return std::nullopt;
  const auto first_moment = [&](double share_early) {
    double sum = 0.0;
    const double step_s = duration_s / kPieces;
    for (int i = 0; i < kPieces; ++i) {
      const double at_s = (i + 0.5) * step_s;
      const double early = at_s < length_s ? 1.0 : 0.0;
      const double late = at_s > duration_s - length_s ? 1.0 : 0.0;
      const double share = share_early * early + (1.0 - share_early) * late;
      sum += (duration_s - at_s) * force_m_s2 * share * step_s;
    }
    return sum;
  };
  if (m.first_moment_m < first_moment(0.0) || m.first_moment_m > first_moment(1.0)) {
    return std::nullopt;
  }
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double mid = 0.5 * (low + high);
    (first_moment(mid) < m.first_moment_m ? low : high) = mid;
  }
  return low;
}

struct Case {
  PushMoments moments;
  double duration_s = 0.0;
  double force_m_s2 = 0.0;
};
Case random_case(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Case out;
  out.duration_s = 0.2 + unit(random);
  out.force_m_s2 = 10.0 + 30.0 * unit(random);
  const double most = out.force_m_s2 * out.duration_s;
  out.moments.impulse_m_s = most * (-0.1 + 1.2 * unit(random));
  out.moments.first_moment_m =
      out.moments.impulse_m_s * out.duration_s * (-0.1 + 1.2 * unit(random));
  return out;
}

TEST(PushReach, RefusesIfAndOnlyIfNoDenseForceExists) {
  int yes = 0;
  int no = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    const Case c = random_case(seed);
    const double apart = separation(c.moments, c.duration_s, c.force_m_s2);
    if (std::abs(apart) < 2e-3) continue;  // The grids' own error.
    const bool answer = is_reachable(c.moments, c.duration_s, c.force_m_s2);
    EXPECT_EQ(answer, apart <= 0.0) << seed << " " << apart;
    ++(answer ? yes : no);
  }
  EXPECT_GT(yes + no, 200);
  EXPECT_GT(no, 100);
}

TEST(PushReach, AForceCanBeConstructedForReachableMoments) {
  int built = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Case c = random_case(seed);
    if (!is_reachable(c.moments, c.duration_s, c.force_m_s2)) continue;
    PushMoments inside = c.moments;
    const double margin = 0.004 * c.duration_s * c.duration_s * c.force_m_s2;
    inside.first_moment_m += margin;
    const bool has_room = is_reachable(inside, c.duration_s, c.force_m_s2);
    inside.first_moment_m -= 2.0 * margin;
    if (!has_room || !is_reachable(inside, c.duration_s, c.force_m_s2)) continue;
    EXPECT_TRUE(share_of_early_block(c.moments, c.duration_s, c.force_m_s2)) << seed;
    ++built;
  }
  EXPECT_GT(built, 50);
}

TEST(PushReach, WithoutALimitTheConeOfMomentsDecides) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    const Case c = random_case(seed);
    // Farkas: no force exists if and only if a direction with a + b s <= 0 for all s in
    // [0, T] has a m0 + b m1 > 0. Such directions form a cone with two edges.
    const double t = c.duration_s;
    const double m0 = c.moments.impulse_m_s;
    const double m1 = c.moments.first_moment_m;
    const bool separated = -m1 > 0.0 || -t * m0 + m1 > 0.0;
    EXPECT_EQ(is_reachable(c.moments, t), !separated && m0 > 0.0) << seed;
  }
}

TEST(PushReach, NamesTheObstacle) {
  EXPECT_EQ(find_obstacle({5.0, 1.0}, 0.5, 30.0), PushObstacle::kNone);
  EXPECT_EQ(find_obstacle({-1.0, 1.0}, 0.5), PushObstacle::kPullDown);
  EXPECT_EQ(find_obstacle({5.0, -0.1}, 0.5), PushObstacle::kEndTooLow);
  EXPECT_EQ(find_obstacle({5.0, 2.6}, 0.5), PushObstacle::kEndTooHigh);
  EXPECT_EQ(find_obstacle({5.0, 0.3}, 0.5, 30.0), PushObstacle::kEndTooLow);
  EXPECT_EQ(find_obstacle({5.0, 2.2}, 0.5, 30.0), PushObstacle::kEndTooHigh);
  EXPECT_EQ(find_obstacle({16.0, 4.0}, 0.5, 30.0), PushObstacle::kStrength);
}

TEST(PushReach, TheRangeOfEndSpeedsHoldsExactlyTheReachableOnes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int ranges = 0;
  for (int i = 0; i < 500; ++i) {
    PushEnds ends;
    ends.start_m_s = -3.0 + 4.0 * unit(random);
    ends.end_m = -0.4 + 0.8 * unit(random);
    ends.duration_s = 0.2 + 0.8 * unit(random);
    std::optional<double> limit;
    if (i % 3 != 0) limit = 12.0 + 30.0 * unit(random);
    const auto range = reachable_end_speeds(ends, limit);
    const auto reaches = [&](double speed_m_s) {
      PushEnds wanted = ends;
      wanted.end_m_s = speed_m_s;
      return is_reachable(push_moments(wanted), ends.duration_s, limit);
    };
    if (!range) {
      for (double v = -20.0; v < 20.0; v += 0.25) EXPECT_FALSE(reaches(v)) << i;
      continue;
    }
    ++ranges;
    EXPECT_FALSE(reaches(range->min_m_s - 1e-6)) << i;
    if (!range->max_m_s) {
      EXPECT_TRUE(reaches(range->min_m_s + 1e-6)) << i;
      EXPECT_TRUE(reaches(range->min_m_s + 100.0)) << i;
      continue;
    }
    EXPECT_FALSE(reaches(*range->max_m_s + 1e-6)) << i;
    for (const double share : {1e-6, 0.3, 0.7, 1.0 - 1e-6}) {
      const double speed_m_s =
          range->min_m_s + share * (*range->max_m_s - range->min_m_s);
      EXPECT_TRUE(reaches(speed_m_s)) << i << " " << share;
    }
  }
  EXPECT_GT(ranges, 200);
}

}  // namespace
}  // namespace marey::dynamics
