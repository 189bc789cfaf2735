// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/label_sets.h"

#include <vector>

namespace marey::reconstruct {

std::span<const LabelSet> label_sets() {
  static const std::vector<LabelSet> sets = [] {
    std::vector<LabelSet> all;
    for (const auto part : {gait_label_sets(),
                            model_label_sets(),
                            animation_label_sets(),
                            studio_label_sets(),
                            palpated_label_sets()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return sets;
}

}  // namespace marey::reconstruct
