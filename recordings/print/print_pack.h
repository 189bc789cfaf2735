// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "recordings/print/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

struct PieceSize {
  double width = 0.0;
  double height = 0.0;
};

/// Position of a piece of paper.
struct PiecePlace {
  std::size_t piece = 0;
  int page = 0;
  glm::dvec2 corner{0.0};  ///< Top left, on the page.
};

/// Packs pieces into rows, and rows into pages with the area `space`, `gap_m` apart, tall
/// pieces first and otherwise in their order. The rows of each page are centred. Each
/// page holds as many pieces of one size as fit upright. Precondition: each piece alone
/// fits into `space`.
[[nodiscard]] std::vector<PiecePlace> pack(std::span<const PieceSize> pieces,
                                           const PrintBox& space,
                                           double gap_m);

}  // namespace marey::recordings
