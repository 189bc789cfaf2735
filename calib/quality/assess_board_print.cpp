// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_board_print.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/quantile.h"

namespace marey::calib {
namespace {

// In focus and with good light, squares are measured to a quarter of a percent. Spread
// ink and an overexposed image reduce squares of some centimetres by less than one
// percent.
constexpr double kFairShrinkage = 0.008;
// On a square of 10 cm and its gap this is 2 mm; all distances in the volume have the
// same relative error.
constexpr double kPoorShrinkage = 0.015;

}  // namespace

void assess_board_print(FindingCollector& list) {
  std::vector<double> slopes;
  for (const Camera& camera : list.report.rig.cameras) {
    slopes.push_back(camera.tag_shrinkage.slope);
  }
  if (slopes.empty()) return;
  const double shrinkage = median(std::move(slopes));
  if (std::abs(shrinkage) <= kFairShrinkage) return;
  list.add(
          severity_of(std::abs(shrinkage), kPoorShrinkage),
          "print",
          "[board]",
          format_text("its black squares look %.1f %% ", 100.0 * std::abs(shrinkage)) +
              (shrinkage > 0.0 ? "smaller" : "larger") +
              format_text(" than the gaps between them require (good: under %.1f): all "
                          "lengths may "
                          "have the same error",
                          100.0 * kFairShrinkage),
          "measure the print (edge of a black square, gap between two, best over a whole "
          "row) and correct tag_size_m or gap_m; use a shorter exposure if squares look "
          "swollen or eroded")
      .measured(100.0 * std::abs(shrinkage), 100.0 * kFairShrinkage, "%");
}

}  // namespace marey::calib
