// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_print.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/quantile.h"

namespace marey::app {
namespace {

// In focus and well lit, squares are found to a quarter of a percent. Ink that ran, and a
// picture that is too bright, take less than a percent off squares of some centimetres.
constexpr double kFairShrinkage = 0.008;
// This much off a square of 10 cm and its gap is 2 mm on the ruler, and as great a share
// off every distance in the volume.
constexpr double kPoorShrinkage = 0.015;

}  // namespace

void judge_print(FindingList& list) {
  std::vector<double> slopes;
  for (const Camera& camera : list.report.rig.cameras) {
    slopes.push_back(camera.tag_shrinkage.slope);
  }
  if (slopes.empty()) return;
  const double shrinkage = median(std::move(slopes));
  if (std::abs(shrinkage) <= kFairShrinkage) return;
  list.add(
      graver(std::abs(shrinkage), kPoorShrinkage),
      "print",
      "[board]",
      worded("its black squares look %.1f %% ", 100.0 * std::abs(shrinkage)) +
          (shrinkage > 0.0 ? "smaller" : "larger") +
          worded(" than the distances between them allow (good: under %.1f): all lengths "
                 "may be wrong by as much",
                 100.0 * kFairShrinkage),
      "measure the print (edge of a black square, gap between two, best over a whole "
      "row) "
      "and correct tag_size_m or gap_m; expose shorter if squares look swollen or eaten");
}

}  // namespace marey::app
