// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/tag_pattern.h"

// Private to capture/.
namespace marey::capture {

/// How much of a blurred point each cell of a row of cells contributes, with derivatives.
struct CellWeights {
  static constexpr int kMost = 16;
  int first = 0;
  int count = 0;
  std::array<double, kMost> weight{};
  std::array<double, kMost> by_place{};      ///< d weight / d place. [1/cell]
  std::array<double, kMost> by_log_sigma{};  ///< d weight / d log(sigma).
};

/// Weights of a Gaussian at `place` over a row of `cells` unit cells, the outer two of
/// which have no end. `place` 0 is where the first cell begins. Cells more than 3.2
/// sigma away are left out, and all beyond the first CellWeights::kMost.
/// Preconditions: sigma > 0, cells > 0.
void weigh_cells(double place, double sigma, int cells, CellWeights& out);

/// The blurred pattern at a point: 0 black, 1 white, and its derivatives.
struct Blurred {
  double value = 0.0;
  double by_u = 0.0;
  double by_v = 0.0;
  double by_log_sigma = 0.0;
  bool flat = false;  ///< All cells in reach are of one colour: no derivative.
};

/// The pattern where the weights say, columns by `u` and rows by `v`.
/// Precondition: both are of this pattern's number of cells.
[[nodiscard]] Blurred blurred(const TagPattern& pattern,
                              const CellWeights& u,
                              const CellWeights& v);

}  // namespace marey::capture
