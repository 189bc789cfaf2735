// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/throw_trials.h"

#include <algorithm>
#include <utility>

#include "core/base/split_mix.h"

namespace marey {
namespace {

void shuffle_trials(std::vector<PlannedTrial>& order,
                    std::size_t first,
                    SplitMix& random) {
  for (std::size_t i = order.size() - first; i-- > 1;) {
    const auto j = static_cast<std::size_t>(random.below(i + 1));
    std::swap(order[first + i], order[first + j]);
  }
}

int max_repeat(const TrialList& list) {
  int repeat = 0;
  for (const ThrowTrial& trial : list.trials) repeat = std::max(repeat, trial.repeat);
  return repeat;
}

}  // namespace

std::vector<PlannedTrial> trial_order(const TrialList& list) {
  std::vector<PlannedTrial> order;
  SplitMix random(list.seed);
  if (list.order == TrialOrder::kBlocks) {
    for (int block = 0; block < max_repeat(list); ++block) {
      const std::size_t first = order.size();
      for (std::size_t k = 0; k < list.trials.size(); ++k) {
        if (block < list.trials[k].repeat) order.push_back({k, block});
      }
      shuffle_trials(order, first, random);
    }
    return order;
  }
  for (std::size_t k = 0; k < list.trials.size(); ++k) {
    for (int r = 0; r < list.trials[k].repeat; ++r) order.push_back({k, r});
  }
  if (list.order == TrialOrder::kShuffled) shuffle_trials(order, 0, random);
  return order;
}

}  // namespace marey
