// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/detail/distribute.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"

namespace marey::engine {
namespace {

using Requests = std::vector<DetailRequest>;
using Details = std::vector<Detail>;

DetailBudget made_budget(const DetailOptions& options = {}) {
  Result<DetailBudget> budget = DetailBudget::make(options);
  EXPECT_TRUE(budget) << (budget ? "" : budget.error().message());
  return *std::move(budget);
}

Requests random_requests(std::mt19937_64& random, std::size_t count) {
  Requests requests(count);
  for (std::size_t i = 0; i < count; ++i) {
    requests[i].id = static_cast<std::uint32_t>(3 * i + 1);
    // Some equal ones, so that ids decide.
    requests[i].importance = static_cast<double>(random() % 8) / 4.0;
    requests[i].min_level = static_cast<std::uint8_t>(random() % 2);
    requests[i].max_level =
        static_cast<std::uint8_t>(requests[i].min_level + random() % 3);
  }
  std::shuffle(requests.begin(), requests.end(), random);
  return requests;
}

/// The best value of all details within the budget; below zero: none is within it.
double best_value(const DetailBudget& budget,
                  const Requests& requests,
                  std::size_t from,
                  double units) {
  if (from == requests.size()) return 0.0;
  const DetailRequest& request = requests[from];
  double best = -1.0;
  for (int level = request.min_level; level <= request.max_level; ++level) {
    for (int rate = 0; rate < kDetailRates; ++rate) {
      const Detail detail{static_cast<std::uint8_t>(level),
                          static_cast<DetailRate>(rate)};
      const double left = units - budget.cost_units(detail);
      if (left < 0.0) continue;
      const double rest = best_value(budget, requests, from + 1, left);
      if (rest < 0.0) continue;
      best = std::max(best, request.importance * budget.value(detail) + rest);
    }
  }
  return best;
}

double total_value(const DetailBudget& budget,
                   const Requests& requests,
                   const Details& details) {
  double sum = 0.0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    sum += requests[i].importance * budget.value(details[i]);
  }
  return sum;
}

double total_cost(const DetailBudget& budget, const Details& details) {
  double sum = 0.0;
  for (const Detail& detail : details) sum += budget.cost_units(detail);
  return sum;
}

double cheapest_cost(const DetailBudget& budget, const Requests& requests) {
  double sum = 0.0;
  for (const DetailRequest& request : requests) {
    sum += budget.cost_units({request.min_level, DetailRate::kQuarter});
  }
  return sum;
}

/// The largest value of one upgrade of any request.
double largest_upgrade(const DetailBudget& budget, const Requests& requests) {
  double largest = 0.0;
  for (const DetailRequest& request : requests) {
    const auto steps = budget.ladder(request.min_level, request.max_level);
    for (std::size_t k = 1; k < steps.size(); ++k) {
      const double gain = budget.value(steps[k]) - budget.value(steps[k - 1]);
      largest = std::max(largest, request.importance * gain);
    }
  }
  return largest;
}

TEST(DetailBudget, LaddersAreTheUpperHullOfCostAndValue) {
  const DetailBudget budget = made_budget();
  for (int low = 0; low < kDetailLevels; ++low) {
    for (int high = low; high < kDetailLevels; ++high) {
      const auto steps = budget.ladder(low, high);
      EXPECT_EQ(steps.front(),
                (Detail{static_cast<std::uint8_t>(low), DetailRate::kQuarter}));
      EXPECT_EQ(steps.back(),
                (Detail{static_cast<std::uint8_t>(high), DetailRate::kFull}));
      double slope_before = std::numeric_limits<double>::infinity();
      for (std::size_t k = 1; k < steps.size(); ++k) {
        const double units =
            budget.cost_units(steps[k]) - budget.cost_units(steps[k - 1]);
        const double slope =
            (budget.value(steps[k]) - budget.value(steps[k - 1])) / units;
        EXPECT_GT(units, 0.0);
        EXPECT_LE(slope, slope_before);
        slope_before = slope;
      }
    }
  }
}

TEST(DetailBudget, IsWithinOneUpgradeOfTheBestAndNeverExceedsTheBudget) {
  std::mt19937_64 random(11);
  DetailBudget budget = made_budget();
  int equal = 0;
  constexpr int kCases = 400;
  for (int n = 0; n < kCases; ++n) {
    const Requests requests = random_requests(random, 1 + random() % 4);
    const double units = static_cast<double>(random() % 300) / 10.0;
    Details details(requests.size());
    const double cost = budget.distribute(requests, units, details);
    EXPECT_NEAR(cost, total_cost(budget, details), 1e-12);
    const double cheapest = cheapest_cost(budget, requests);
    EXPECT_LE(cost, std::max(units, cheapest + 1e-12)) << n;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      EXPECT_GE(details[i].level, requests[i].min_level);
      EXPECT_LE(details[i].level, requests[i].max_level);
    }
    if (units < cheapest) continue;
    const double best = best_value(budget, requests, 0, units);
    const double value = total_value(budget, requests, details);
    EXPECT_LE(value, best + 1e-12);
    EXPECT_GE(value, best - largest_upgrade(budget, requests) - 1e-12) << n;
    equal += value >= best - 1e-12 ? 1 : 0;
  }
  EXPECT_GT(equal, kCases / 10);
}

// At the budgets that the upgrades themselves end at, greedy is optimal.
TEST(DetailBudget, IsOptimalAtTheCostsOfItsOwnUpgrades) {
  std::mt19937_64 random(12);
  DetailBudget budget = made_budget();
  for (int n = 0; n < 100; ++n) {
    const Requests requests = random_requests(random, 1 + random() % 4);
    Details details(requests.size());
    const double units =
        budget.distribute(requests, static_cast<double>(random() % 300) / 10.0, details);
    const double best = best_value(budget, requests, 0, units + 1e-9);
    EXPECT_NEAR(total_value(budget, requests, details), best, 1e-9) << n;
  }
}

TEST(DetailBudget, ALargerBudgetGivesNoCharacterLess) {
  std::mt19937_64 random(13);
  DetailBudget budget = made_budget();
  for (int n = 0; n < 100; ++n) {
    const Requests requests = random_requests(random, 1 + random() % 40);
    Details before(requests.size());
    budget.distribute(requests, 0.0, before);
    for (double units = 0.0; units < 400.0; units += 7.3) {
      Details after(requests.size());
      budget.distribute(requests, units, after);
      for (std::size_t i = 0; i < requests.size(); ++i) {
        EXPECT_GE(budget.value(after[i]), budget.value(before[i]));
        EXPECT_GE(budget.cost_units(after[i]), budget.cost_units(before[i]));
      }
      before = after;
    }
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (requests[i].importance > 0.0) {
        EXPECT_EQ(before[i].level, requests[i].max_level);
        EXPECT_EQ(before[i].rate, DetailRate::kFull);
      }
    }
  }
}

TEST(DetailBudget, AMoreImportantCharacterHasNoLess) {
  std::mt19937_64 random(14);
  DetailBudget budget = made_budget();
  for (int n = 0; n < 200; ++n) {
    Requests requests = random_requests(random, 30);
    for (DetailRequest& request : requests) {
      request.min_level = 0;
      request.max_level = 3;
    }
    Details details(requests.size());
    budget.distribute(requests, static_cast<double>(random() % 250), details);
    for (std::size_t a = 0; a < requests.size(); ++a) {
      for (std::size_t b = 0; b < requests.size(); ++b) {
        const bool is_first = requests[a].importance > requests[b].importance ||
                              (requests[a].importance == requests[b].importance &&
                               requests[a].id < requests[b].id);
        if (is_first) {
          EXPECT_GE(budget.value(details[a]), budget.value(details[b]));
        }
      }
    }
  }
}

TEST(DetailBudget, OrderOfTheRequestsDoesNotMatter) {
  std::mt19937_64 random(15);
  DetailBudget budget = made_budget();
  for (int n = 0; n < 200; ++n) {
    Requests requests = random_requests(random, 50);
    const double units = static_cast<double>(random() % 3000) / 10.0;
    const auto by_id = [&](const Requests& some, const Details& details) {
      std::vector<std::pair<std::uint32_t, Detail>> all;
      for (std::size_t i = 0; i < some.size(); ++i) {
        all.emplace_back(some[i].id, details[i]);
      }
      std::sort(all.begin(), all.end());
      return all;
    };
    Details details(requests.size());
    const double cost = budget.distribute(requests, units, details);
    const auto expected = by_id(requests, details);
    std::shuffle(requests.begin(), requests.end(), random);
    EXPECT_EQ(budget.distribute(requests, units, details), cost);
    EXPECT_EQ(by_id(requests, details), expected);
  }
}

TEST(DetailBudget, AllocatesNothingAfterReserve) {
  std::mt19937_64 random(16);
  DetailBudget budget = made_budget();
  const Requests requests = random_requests(random, 1000);
  Details details(requests.size());
  budget.reserve(requests.size());
  const long before = testing::allocations();
  for (const double units : {0.0, 1000.0, 4000.0, 1e9}) {
    budget.distribute(requests, units, details);
  }
  EXPECT_EQ(testing::allocations(), before);
}

TEST(DetailBudget, TheTableOfTheReferenceMachineGivesForty) {
  DetailBudget budget = made_budget();
  Requests forty(40);
  for (std::size_t i = 0; i < forty.size(); ++i) {
    forty[i].id = static_cast<std::uint32_t>(i);
  }
  Details details(forty.size());
  // All at level 3 cost 360 units; a quarter of level 0 costs 20.
  EXPECT_EQ(budget.distribute(forty, 400.0, details), 360.0);
  EXPECT_EQ(details[17], (Detail{3, DetailRate::kFull}));
  EXPECT_EQ(budget.distribute(forty, 10.0, details), 20.0);
  EXPECT_EQ(details[17], (Detail{0, DetailRate::kQuarter}));
}

TEST(DetailBudget, RefusesTablesThatDoNotGrow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::array<double, 4>& units : {std::array{2.0, 7.0, 6.0, 9.0},
                                             std::array{0.0, 7.0, 8.0, 9.0},
                                             std::array{-1.0, 7.0, 8.0, 9.0},
                                             std::array{2.0, nan, 8.0, 9.0},
                                             std::array{2.0, 7.0, 8.0, 1.0 / 0.0}}) {
    DetailOptions options;
    options.cost_units = costs_of(units);
    const auto budget = DetailBudget::make(options);
    ASSERT_FALSE(budget);
    EXPECT_EQ(budget.error().code, Errc::kBadInput);
    EXPECT_EQ(budget.error().where, "costs of the levels of detail");
  }
  DetailOptions options;
  options.value[2][0] = 0.1;
  EXPECT_FALSE(DetailBudget::make(options));
}

}  // namespace
}  // namespace marey::engine
