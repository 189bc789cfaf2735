// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/actions/action_weights.h"

#include <algorithm>

#include "core/base/assert.h"

namespace marey::engine {

void action_weights(std::span<const Action* const> actions,
                    double time_s,
                    std::span<PerGroup> out) {
  MAREY_ASSERT(out.size() == actions.size());
  PerGroup open = whole_body();
  std::size_t end = actions.size();
  while (end > 0) {
    std::size_t begin = end - 1;
    while (begin > 0 && actions[begin - 1]->layer == actions[end - 1]->layer) --begin;
    PerGroup sum{};
    PerGroup cover{};
    for (std::size_t i = begin; i < end; ++i) {
      const float fade = static_cast<float>(actions[i]->fade(time_s));
      for (std::size_t g = 0; g < kGroupCount; ++g) {
        const float share = actions[i]->source_share[g] * fade;
        out[i][g] = actions[i]->weight * actions[i]->priority[g] * share;
        sum[g] += out[i][g];
        cover[g] += std::min(1.0F, actions[i]->priority[g]) * share;
      }
    }
    for (std::size_t g = 0; g < kGroupCount; ++g) {
      const float share = std::min(1.0F, cover[g]);
      for (std::size_t i = begin; i < end; ++i) {
        out[i][g] = sum[g] > 0.0F ? open[g] * share * out[i][g] / sum[g] : 0.0F;
      }
      open[g] *= 1.0F - share;
    }
    end = begin;
  }
}

}  // namespace marey::engine
