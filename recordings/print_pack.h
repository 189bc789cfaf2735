// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "recordings/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

struct PieceSize {
  double width = 0.0;
  double height = 0.0;
};

/// Where a piece of paper went.
struct PiecePlace {
  std::size_t piece = 0;
  int page = 0;
  glm::dvec2 corner{0.0};  ///< Top left, on the page.
};

/// Puts pieces into rows, rows into pages whose room is `space`, `gap_m` apart, high
/// pieces first and otherwise in their order; each page's rows are moved to its middle.
/// Of pieces of one size as many as can lie upright come on each page.
/// Precondition: each piece alone fits into `space`.
[[nodiscard]] std::vector<PiecePlace> pack(std::span<const PieceSize> pieces,
                                           const PrintBox& space,
                                           double gap_m);

}  // namespace marey::recordings
