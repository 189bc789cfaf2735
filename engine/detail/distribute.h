// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace marey::engine {

/// Levels of detail: 0 sampled, blended and expanded; 1 also supports and constraints; 2
/// also balance; 3 also dynamics.
inline constexpr int kDetailLevels = 4;

/// Share of the steps that are computed; those between are interpolated.
enum class DetailRate : std::uint8_t { kQuarter, kHalf, kFull };
inline constexpr int kDetailRates = 3;

/// Returns the number of steps from one computed step to the next: 4, 2 or 1.
[[nodiscard]] constexpr int period_steps(DetailRate rate) {
  return 4 >> static_cast<int>(rate);
}

/// Detail of one character. Ordered by level, then by rate.
struct Detail {
  std::uint8_t level = 0;
  DetailRate rate = DetailRate::kQuarter;
  auto operator<=>(const Detail&) const = default;
};

/// A number for each level and rate: [level][rate].
using DetailTable = std::array<std::array<double, kDetailRates>, kDetailLevels>;

/// Returns the table of a cost of full steps for each level: half and quarter rates cost
/// a half and a quarter of it. [units]
[[nodiscard]] DetailTable costs_of(const std::array<double, kDetailLevels>& full_units);

struct DetailOptions {
  /// Cost of a character in a mean step. One unit is 1 microsecond on the reference
  /// machine.
  DetailTable cost_units = costs_of({2.0, 7.0, 8.0, 9.0});
  /// Value of a character of importance 1. The differences between levels are ours:
  /// planted feet count as much as the motion itself, balance and dynamics little.
  DetailTable value{{{0.4, 0.7, 1.0},  //
                     {0.8, 1.4, 2.0},
                     {0.88, 1.54, 2.2},
                     {0.92, 1.61, 2.3}}};
};

/// A character that the budget is distributed to.
struct DetailRequest {
  std::uint32_t id = 0;     ///< Different for each.
  double importance = 1.0;  ///< Finite, >= 0: the user's, or 1 / distance.
  std::uint8_t min_level = 0;
  std::uint8_t max_level = kDetailLevels - 1;  ///< >= min_level; below kDetailLevels.
};

/// Distributes a budget of cost units among characters. Each begins with the cheapest
/// detail between its levels, level 0 at a quarter of the rate by default; then the
/// upgrade that gains the most importance per unit is taken, of equal ones that of the
/// lowest id, as long as the budget suffices (greedy along the upper convex hull of cost
/// and value; Sinha, Zoltners 1979, "The multiple-choice knapsack problem").
///
/// Upgrades are taken in an order that does not depend on the budget, and the first one
/// that the budget does not pay for ends it. So a larger budget gives no character less,
/// and a smaller importance of others never gives it less. The total value is at most the
/// value of that one upgrade below the best possible. No clock: same input, same bytes;
/// the order of the requests does not matter.
class DetailBudget {
 public:
  /// Errors (bad input): a number that is not finite; a cost that is not positive; a cost
  /// or a value that does not grow with the level and the rate.
  [[nodiscard]] static Result<DetailBudget> make(const DetailOptions& options = {});

  /// Allocates for this number of characters.
  void reserve(std::size_t characters);

  /// Chooses the detail of each request. Returns the cost of all [units]: at most
  /// `budget_units`, except where the cheapest details already cost more. Cost:
  /// n log n. Allocates nothing for up to the reserved number of characters.
  /// Preconditions: requests are as DetailRequest states, `out` has as many elements;
  /// the budget is not NaN.
  double distribute(std::span<const DetailRequest> requests,
                    double budget_units,
                    std::span<Detail> out);

  [[nodiscard]] double cost_units(const Detail& detail) const {
    return options_.cost_units[detail.level][static_cast<std::size_t>(detail.rate)];
  }
  [[nodiscard]] double value(const Detail& detail) const {
    return options_.value[detail.level][static_cast<std::size_t>(detail.rate)];
  }
  /// Details that a character between these levels can have, cheapest first.
  [[nodiscard]] std::span<const Detail> ladder(int min_level, int max_level) const;

 private:
  struct Ladder {
    std::array<Detail, kDetailLevels * kDetailRates> steps{};
    std::size_t count = 0;
  };
  struct Upgrade {
    double gain_per_unit = 0.0;
    std::size_t request = 0;
    std::uint32_t id = 0;
    std::uint8_t step = 0;  // For the ladder, after the upgrade.
  };

  explicit DetailBudget(const DetailOptions& options);
  [[nodiscard]] Ladder make_ladder(int min_level, int max_level) const;
  [[nodiscard]] Upgrade upgrade(const DetailRequest& request,
                                std::size_t position,
                                std::size_t step) const;

  DetailOptions options_;
  std::array<std::array<Ladder, kDetailLevels>, kDetailLevels> ladders_{};  // [min][max]
  std::vector<std::size_t> by_id_;
  std::vector<Upgrade> heap_;
};

}  // namespace marey::engine
