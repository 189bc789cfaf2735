// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/plan_sync.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"

namespace marey::engine {
namespace {

/// Feet of a clip at any time, by search.
PhaseClass feet_at(const SyncSide& side, double source_s) {
  if (side.loops) source_s -= std::floor(source_s / side.duration_s) * side.duration_s;
  for (const Phase& phase : side.phases) {
    if (source_s < phase.end_s) return phase.feet;
  }
  return side.phases.back().feet;
}

/// All changes of feet between -4 and 8 s, unwrapped.
std::vector<double> changes_of(const SyncSide& side, bool of_flight) {
  std::vector<double> edges;
  const int cycles = side.loops ? static_cast<int>(10.0 / side.duration_s) + 1 : 0;
  for (int cycle = -cycles; cycle <= cycles; ++cycle) {
    for (std::size_t i = side.loops ? 0 : 1; i < side.phases.size(); ++i) {
      const PhaseClass a =
          side.phases[(i + side.phases.size() - 1) % side.phases.size()].feet;
      const PhaseClass b = side.phases[i].feet;
      if (a == b) continue;
      if (of_flight && (a == PhaseClass::kNone) == (b == PhaseClass::kNone)) continue;
      edges.push_back(side.phases[i].start_s + cycle * side.duration_s);
    }
  }
  return edges;
}

double nearest_s(const std::vector<double>& edges, double at_s) {
  double nearest = 1e9;
  for (const double edge : edges) nearest = std::min(nearest, std::abs(edge - at_s));
  return nearest;
}

struct Reference {
  SyncSide lead;
  SyncSide follower;
  SyncOptions options;
  std::vector<double> lead_flights = changes_of(lead, true);
  std::vector<double> follower_flights = changes_of(follower, true);
  std::vector<double> lead_edges;  ///< Times from now; the first is 0.
  std::vector<double> follower_edges = changes_of(follower, false);
  double horizon_s = 0.0;
  double best = 1e9;

  Reference(const SyncSide& a, const SyncSide& b, const SyncOptions& o)
      : lead(a), follower(b), options(o), lead_edges{0.0}, horizon_s(o.horizon_s) {
    for (const double edge : changes_of(lead, false)) {
      const double t = (edge - lead.now_s) / lead.speed;
      if (t < 1e-6 || lead_edges.size() > 8 || lead_edges.back() >= horizon_s) continue;
      lead_edges.push_back(t);
    }
    if (lead_edges.size() > 8) horizon_s = std::min(horizon_s, lead_edges.back());
  }

  /// By the classes in the middle between all times at which anything changes.
  [[nodiscard]] double incompatible(double t0, double s0, double t1, double rate) const {
    t1 = std::min(t1, horizon_s);
    if (t1 <= t0) return 0.0;
    std::vector<double> times{t0, t1};
    const auto add = [&](double t) {
      if (t > t0 && t < t1) times.push_back(t);
    };
    for (const double d : {-kFlightEdge_s, 0.0, kFlightEdge_s}) {
      for (const double e : changes_of(lead, false))
        add((e + d - lead.now_s) / lead.speed);
      for (const double e : follower_edges) add(t0 + (e + d - s0) / rate);
    }
    std::sort(times.begin(), times.end());
    double sum = 0.0;
    for (std::size_t i = 1; i < times.size(); ++i) {
      const double t = 0.5 * (times[i - 1] + times[i]);
      const double a = lead.now_s + t * lead.speed;
      const double b = s0 + (t - t0) * rate;
      const double from_edge =
          std::min(nearest_s(lead_flights, a), nearest_s(follower_flights, b));
      if (!are_compatible(feet_at(lead, a), feet_at(follower, b), from_edge)) {
        sum += times[i] - times[i - 1];
      }
    }
    return sum;
  }

  /// All courses that start from this match.
  void enumerate(double t0, double s0, double cost) {
    if (cost >= best) return;
    const auto first = std::find(lead_edges.begin(), lead_edges.end(), t0);
    const double tail = incompatible(t0, s0, horizon_s, follower.speed);
    best = std::min(best, cost + options.incompatible_cost_per_s * tail);
    auto place =
        std::upper_bound(follower_edges.begin(), follower_edges.end(), s0 + 1e-9);
    for (auto to = first + 1; to < lead_edges.end() && to - first <= 4; ++to) {
      for (auto e = place; e < follower_edges.end() && e - place < 4; ++e) {
        const double ratio = (*e - s0) / ((*to - t0) * follower.speed);
        if (ratio < options.min_rate - 1e-9 || ratio > options.max_rate + 1e-9) continue;
        const double span = std::max(0.0, std::min(*to, horizon_s) - t0);
        const double more = span * std::log(ratio) * std::log(ratio) +
                            options.incompatible_cost_per_s *
                                incompatible(t0, s0, *to, ratio * follower.speed);
        enumerate(*to, *e, cost + more);
      }
    }
  }
};

std::vector<Phase> random_phases(std::mt19937_64& random, double& duration_s) {
  std::vector<Phase> phases;
  const std::size_t count = 1 + random() % 7;
  double t = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    auto feet = static_cast<PhaseClass>(random() % 4);
    while (i > 0 && feet == phases.back().feet) {
      feet = static_cast<PhaseClass>(random() % 4);
    }
    const double length = std::uniform_real_distribution<double>(0.05, 0.5)(random);
    phases.push_back({feet, t, t + length});
    t += length;
  }
  duration_s = t;
  return phases;
}

TEST(PlanSync, CostsAsMuchAsTheBestOfAllMatchings) {
  std::mt19937_64 random(3);
  int inertial = 0;
  int matched = 0;
  for (int i = 0; i < 400; ++i) {
    double a_s = 0.0;
    double b_s = 0.0;
    const auto a = random_phases(random, a_s);
    const auto b = random_phases(random, b_s);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const SyncSide lead{
        a, a_s, random() % 2 == 0, a_s * share(random), 0.7 + share(random)};
    const SyncSide follower{
        b, b_s, random() % 2 == 0, b_s * share(random), 0.7 + share(random)};
    const SyncOptions options;
    Reference reference(lead, follower, options);
    reference.enumerate(0.0, follower.now_s, 0.0);
    const SyncPlan plan = plan_sync(lead, follower, options);
    EXPECT_NEAR(plan.cost, reference.best, 1e-7) << i;
    double again_s = 0.0;
    for (std::size_t k = 1; k < plan.knot_count; ++k) {
      const WarpKnot& p = plan.knots[k - 1];
      const WarpKnot& q = plan.knots[k];
      const double rate = (q.source_s - p.source_s) / (q.time_s - p.time_s);
      again_s += reference.incompatible(p.time_s, p.source_s, q.time_s, rate);
      EXPECT_GT(rate, 0.0);
    }
    if (follower.loops) {
      EXPECT_NEAR(plan.incompatible_s, again_s, 1e-7) << i;
    }
    EXPECT_EQ(plan.knots[0].time_s, 0.0);
    EXPECT_EQ(plan.knots[0].source_s, follower.now_s);
    inertial += plan.only_inertial ? 1 : 0;
    matched += plan.worst_rate != 1.0 ? 1 : 0;
  }
  EXPECT_GT(inertial, 5);
  EXPECT_GT(matched, 50);
}

TEST(PlanSync, EntersAtLeastAsWellAsWhereAsked) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 400; ++i) {
    double a_s = 0.0;
    double b_s = 0.0;
    const auto a = random_phases(random, a_s);
    const auto b = random_phases(random, b_s);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const SyncSide lead{a, a_s, random() % 2 == 0, a_s * share(random), 1.0};
    SyncSide follower{b, b_s, random() % 2 == 0, b_s * share(random), 1.0};
    const SyncPlan free = plan_sync(lead, follower, {.entry_s = 0.3});
    EXPECT_LE(free.cost, plan_sync(lead, follower, {}).cost + 1e-7);
    const double entry_s = free.knots[0].source_s;
    if (!follower.loops) {
      EXPECT_LE(std::abs(entry_s - follower.now_s), 0.3 + 1e-12);
      EXPECT_GE(entry_s, 0.0);
      EXPECT_LE(entry_s, b_s);
    }
    follower.now_s = entry_s;
    Reference reference(lead, follower, {});
    reference.enumerate(0.0, entry_s, 0.0);
    EXPECT_GE(free.cost, reference.best - 1e-7) << i;
  }
}

const std::vector<Phase> kWalk{{PhaseClass::kLeft, 0.0, 0.4},
                               {PhaseClass::kBoth, 0.4, 0.5},
                               {PhaseClass::kRight, 0.5, 0.9},
                               {PhaseClass::kBoth, 0.9, 1.0}};

TEST(PlanSync, EntersTheSameClipWhereTheLeadIs) {
  for (double now_s = 0.013; now_s < 1.0; now_s += 0.05) {
    const SyncPlan plan = plan_sync(
        {kWalk, 1.0, true, now_s, 1.0}, {kWalk, 1.0, true, 0.0, 1.0}, {.entry_s = 0.5});
    EXPECT_LT(plan.incompatible_s, 1e-9);
    EXPECT_LT(plan.cost, 1e-9);
    EXPECT_FALSE(plan.only_inertial);
    EXPECT_GE(plan.knots[0].source_s, 0.0);
    EXPECT_LT(plan.knots[0].source_s, 1.0);
  }
}

TEST(PlanSync, FollowsTheSameClipAtAnotherRateExactly) {
  // Without time on both feet, edges have to be equal.
  const std::vector<Phase> steps{{PhaseClass::kLeft, 0.0, 0.4},
                                 {PhaseClass::kRight, 0.4, 0.7}};
  for (const double speed : {0.8, 0.9, 1.1, 1.25}) {
    const SyncPlan plan =
        plan_sync({steps, 0.7, true, 0.1, 1.0}, {steps, 0.7, true, 0.1, speed}, {});
    EXPECT_LT(plan.incompatible_s, 1e-9);
    EXPECT_GE(plan.knot_count, 3U);
    // The last knot is the horizon: no match.
    for (std::size_t k = 0; k + 1 < plan.knot_count; ++k) {
      EXPECT_NEAR(plan.knots[k].source_s, 0.1 + plan.knots[k].time_s, 1e-12);
    }
  }
}

TEST(PlanSync, TreatsTheSeamOfALoopAsOnePhase) {
  // The same loop, cut within its left step.
  const std::vector<Phase> whole{{PhaseClass::kLeft, 0.0, 0.4},
                                 {PhaseClass::kRight, 0.4, 0.8}};
  const std::vector<Phase> cut{{PhaseClass::kLeft, 0.0, 0.1},
                               {PhaseClass::kRight, 0.1, 0.5},
                               {PhaseClass::kLeft, 0.5, 0.8}};
  const SyncPlan a =
      plan_sync({whole, 0.8, true, 0.3, 1.0}, {whole, 0.8, true, 0.35, 0.9}, {});
  const SyncPlan b =
      plan_sync({cut, 0.8, true, 0.0, 1.0}, {cut, 0.8, true, 0.05, 0.9}, {});
  EXPECT_NEAR(a.cost, b.cost, 1e-12);
  EXPECT_EQ(a.knot_count, b.knot_count);
}

TEST(PlanSync, NeedsNoMatchForAClipWithoutContacts) {
  const std::vector<Phase> seated{{PhaseClass::kAny, 0.0, 2.0}};
  const SyncPlan plan =
      plan_sync({kWalk, 1.0, true, 0.2, 1.0}, {seated, 2.0, false, 0.5, 1.0}, {});
  EXPECT_EQ(plan.cost, 0.0);
  EXPECT_FALSE(plan.only_inertial);
  EXPECT_EQ(plan.knots[0].source_s, 0.5);
}

TEST(PlanSync, StaysInertialWhereNothingMatches) {
  const std::vector<Phase> left{{PhaseClass::kLeft, 0.0, 3.0}};
  const std::vector<Phase> right{{PhaseClass::kRight, 0.0, 3.0}};
  const SyncPlan plan =
      plan_sync({left, 3.0, true, 0.2, 1.0}, {right, 3.0, false, 0.5, 1.0}, {});
  EXPECT_TRUE(plan.only_inertial);
  EXPECT_DOUBLE_EQ(plan.incompatible_s, 1.2);
  EXPECT_EQ(plan.worst_rate, 1.0);
}

TEST(PlanSync, AllocatesNothingAndGivesTheSameBytes) {
  const SyncSide lead{kWalk, 1.0, true, 0.2, 1.0};
  const SyncSide follower{kWalk, 1.0, true, 0.7, 1.2};
  const long before = marey::testing::allocations();
  const SyncPlan a = plan_sync(lead, follower, {.entry_s = 0.5});
  const SyncPlan b = plan_sync(lead, follower, {.entry_s = 0.5});
  EXPECT_EQ(marey::testing::allocations(), before);
  ASSERT_EQ(a.knot_count, b.knot_count);
  EXPECT_EQ(std::memcmp(a.knots.data(), b.knots.data(), sizeof(a.knots)), 0);
  EXPECT_EQ(a.cost, b.cost);
}

}  // namespace
}  // namespace marey::engine
