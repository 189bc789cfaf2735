// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/tag_pattern.h"

// Private to capture.
namespace marey::capture {

/// Contributions of each cell of a row of cells to a blurred point, with derivatives.
struct CellWeights {
  static constexpr int kMax = 16;
  int first = 0;
  int count = 0;
  std::array<double, kMax> weight{};
  std::array<double, kMax> by_place{};      ///< d weight / d place. [1/cell]
  std::array<double, kMax> by_log_sigma{};  ///< d weight / d log(sigma).
};

/// Computes the weights of a Gaussian at `place` over a row of `cells` unit cells; the
/// two outer cells extend to infinity. `place` 0 is the start of the first cell. Cells
/// more than 3.2 sigma away are omitted, and all beyond the first CellWeights::kMax.
/// Preconditions: sigma > 0, cells > 0.
void weigh_cells(double place, double sigma, int cells, CellWeights& out);

/// Value of the blurred pattern at a point (0 black, 1 white) and its derivatives.
struct Blurred {
  double value = 0.0;
  double by_u = 0.0;
  double by_v = 0.0;
  double by_log_sigma = 0.0;
  bool flat = false;  ///< All contributing cells have one colour: no derivative.
};

/// Returns the pattern under the weights: columns by `u` and rows by `v`.
/// Precondition: both have this pattern's number of cells.
[[nodiscard]] Blurred blurred(const TagPattern& pattern,
                              const CellWeights& u,
                              const CellWeights& v);

}  // namespace marey::capture
