// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_pack.h"

#include <algorithm>
#include <numeric>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

constexpr double kPackRounding_m = 1e-9;

/// Centres each page's pieces, which begin at the left.
void centre_pages(std::vector<PiecePlace>& places,
                  std::span<const PieceSize> pieces,
                  const PrintBox& space) {
  for (auto first = places.begin(); first != places.end();) {
    const auto last = std::find_if(
        first, places.end(), [&](const PiecePlace& p) { return p.page != first->page; });
    double right = space.left;
    for (auto p = first; p != last; ++p) {
      right = std::max(right, p->corner.x + pieces[p->piece].width);
    }
    for (auto p = first; p != last; ++p) p->corner.x += 0.5 * (space.right - right);
    first = last;
  }
}

}  // namespace

std::vector<PiecePlace> pack(std::span<const PieceSize> pieces,
                             const PrintBox& space,
                             double gap_m) {
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return pieces[a].height > pieces[b].height + kPackRounding_m;
  });
  std::vector<PiecePlace> places;
  int page = 0;
  double x = space.left;
  double y = space.top;
  double row_height = 0.0;
  for (const std::size_t piece : order) {
    const auto [width, height] = pieces[piece];
    MAREY_ASSERT(width <= space.width() + kPackRounding_m &&
                 height <= space.height() + kPackRounding_m);
    if (x + width > space.right + kPackRounding_m) {
      x = space.left;
      y += row_height + gap_m;
      row_height = 0.0;
    }
    if (y + height > space.bottom + kPackRounding_m) {
      ++page;
      x = space.left;
      y = space.top;
      row_height = 0.0;
    }
    places.push_back({piece, page, {x, y}});
    x += width + gap_m;
    row_height = std::max(row_height, height);
  }
  centre_pages(places, pieces, space);
  return places;
}

}  // namespace marey::recordings
