// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/detail/distribute.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr std::array<DetailRate, kDetailRates> kAllRates{
    DetailRate::kQuarter, DetailRate::kHalf, DetailRate::kFull};

/// Returns whether the numbers are finite and grow with the level and the rate.
bool grows(const DetailTable& table) {
  for (std::size_t level = 0; level < kDetailLevels; ++level) {
    for (std::size_t rate = 0; rate < kDetailRates; ++rate) {
      const double here = table[level][rate];
      if (!std::isfinite(here)) return false;
      if (level > 0 && here <= table[level - 1][rate]) return false;
      if (rate > 0 && here <= table[level][rate - 1]) return false;
    }
  }
  return true;
}

}  // namespace

DetailTable costs_of(const std::array<double, kDetailLevels>& full_units) {
  DetailTable table{};
  for (std::size_t level = 0; level < kDetailLevels; ++level) {
    for (const DetailRate rate : kAllRates) {
      table[level][static_cast<std::size_t>(rate)] =
          full_units[level] / period_steps(rate);
    }
  }
  return table;
}

Result<DetailBudget> DetailBudget::make(const DetailOptions& options) {
  const std::string next = "give four costs in units that ascend with the level";
  if (!grows(options.cost_units) || options.cost_units[0][0] <= 0.0) {
    return bad_input("costs of the levels of detail",
                     "a cost is not positive, or does not grow with level and rate",
                     next);
  }
  if (!grows(options.value)) {
    return bad_input("values of the levels of detail",
                     "a value does not grow with level and rate",
                     "give values that ascend with the level and with the rate");
  }
  return DetailBudget(options);
}

DetailBudget::DetailBudget(const DetailOptions& options) : options_(options) {
  for (int low = 0; low < kDetailLevels; ++low) {
    for (int high = low; high < kDetailLevels; ++high) {
      ladders_[static_cast<std::size_t>(low)][static_cast<std::size_t>(high)] =
          make_ladder(low, high);
    }
  }
}

DetailBudget::Ladder DetailBudget::make_ladder(int min_level, int max_level) const {
  Ladder ladder;
  ladder.steps[0] = {static_cast<std::uint8_t>(min_level), DetailRate::kQuarter};
  ladder.count = 1;
  while (true) {
    const Detail last = ladder.steps[ladder.count - 1];
    const Detail* best = nullptr;
    Detail candidate;
    Detail found;
    double best_gain = 0.0;
    for (int level = min_level; level <= max_level; ++level) {
      for (const DetailRate rate : kAllRates) {
        candidate = {static_cast<std::uint8_t>(level), rate};
        const double units = cost_units(candidate) - cost_units(last);
        const double gain = value(candidate) - value(last);
        if (units <= 0.0 || gain <= 0.0) continue;
        const double per_unit = gain / units;
        // For equal gains per unit the cheaper detail: smaller upgrades fit more often.
        const bool is_equal = best != nullptr && per_unit == best_gain;
        if (per_unit > best_gain ||
            (is_equal && cost_units(candidate) < cost_units(*best))) {
          found = candidate;
          best = &found;
          best_gain = per_unit;
        }
      }
    }
    if (best == nullptr) return ladder;
    ladder.steps[ladder.count++] = *best;
  }
}

std::span<const Detail> DetailBudget::ladder(int min_level, int max_level) const {
  MAREY_ASSERT(0 <= min_level && min_level <= max_level && max_level < kDetailLevels);
  const Ladder& found =
      ladders_[static_cast<std::size_t>(min_level)][static_cast<std::size_t>(max_level)];
  return {found.steps.data(), found.count};
}

void DetailBudget::reserve(std::size_t characters) {
  by_id_.reserve(characters);
  heap_.reserve(characters);
}

DetailBudget::Upgrade DetailBudget::upgrade(const DetailRequest& request,
                                            std::size_t position,
                                            std::size_t step) const {
  const Detail* const steps = ladder(request.min_level, request.max_level).data() + step;
  const double gain = value(steps[0]) - value(steps[-1]);
  const double units = cost_units(steps[0]) - cost_units(steps[-1]);
  return {request.importance * (gain / units),
          position,
          request.id,
          static_cast<std::uint8_t>(step)};
}

double DetailBudget::distribute(std::span<const DetailRequest> requests,
                                double budget_units,
                                std::span<Detail> out) {
  MAREY_ASSERT(out.size() == requests.size() && !std::isnan(budget_units));
  by_id_.resize(requests.size());
  std::iota(by_id_.begin(), by_id_.end(), std::size_t{0});
  std::sort(by_id_.begin(), by_id_.end(), [&](std::size_t a, std::size_t b) {
    return requests[a].id < requests[b].id;
  });
  heap_.clear();
  double total_units = 0.0;  // Summed in the order of ids, then of upgrades.
  for (const std::size_t i : by_id_) {
    const DetailRequest& request = requests[i];
    MAREY_ASSERT(std::isfinite(request.importance) && request.importance >= 0.0);
    const auto steps = ladder(request.min_level, request.max_level);
    out[i] = steps.front();
    total_units += cost_units(out[i]);
    const bool can_rise = steps.size() > 1 && request.importance > 0.0;
    if (can_rise) heap_.push_back(upgrade(request, i, 1));
  }
  const auto is_later = [](const Upgrade& a, const Upgrade& b) {
    if (a.gain_per_unit != b.gain_per_unit) return a.gain_per_unit < b.gain_per_unit;
    return a.id > b.id;
  };
  std::make_heap(heap_.begin(), heap_.end(), is_later);
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), is_later);
    const Upgrade next = heap_.back();
    heap_.pop_back();
    const DetailRequest& request = requests[next.request];
    const auto steps = ladder(request.min_level, request.max_level);
    const double units =
        total_units + (cost_units(steps[next.step]) - cost_units(out[next.request]));
    if (!(units <= budget_units)) break;
    total_units = units;
    out[next.request] = steps[next.step];
    const std::size_t after = next.step + std::size_t{1};
    if (after == steps.size()) continue;
    heap_.push_back(upgrade(request, next.request, after));
    std::push_heap(heap_.begin(), heap_.end(), is_later);
  }
  return total_units;
}

}  // namespace marey::engine
