// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/scan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

#include "library/search/row_kernel.h"

#include "core/base/assert.h"

namespace marey::library {

std::vector<ScanHit> nearest_rows(const ClipRows& clips, std::span<const float> query) {
  MAREY_ASSERT(query.size() == clips.columns && clips.columns % kRowParts == 0);
  MAREY_ASSERT(clips.begins.empty() ||
               clips.begins.back() * clips.columns == clips.values.size());
  const SquaredDistances distances_of = squared_distances();
  // Rows that are compared at once.
  constexpr std::size_t kBlock = 256;
  std::array<float, kBlock> distances{};
  std::vector<ScanHit> hits;
  hits.reserve(static_cast<std::size_t>(clips.clip_count()));
  for (int clip = 0; clip < clips.clip_count(); ++clip) {
    const std::span<const float> rows = clips.rows(clip);
    const std::size_t count = clips.row_count(clip);
    if (count == 0) continue;
    ScanHit best{clip, -1, 0.0F};
    for (std::size_t first = 0; first < count; first += kBlock) {
      const std::size_t size = std::min(kBlock, count - first);
      distances_of(rows.data() + first * clips.columns,
                   size,
                   clips.columns,
                   query.data(),
                   distances.data());
      for (std::size_t k = 0; k < size; ++k) {
        if (best.row < 0 || distances[k] < best.squared_distance) {
          best.row = static_cast<int>(first + k);
          best.squared_distance = distances[k];
        }
      }
    }
    hits.push_back(best);
  }
  return hits;
}

void keep_nearest(std::vector<ScanHit>& hits, int count) {
  const auto kept = std::min(hits.size(), static_cast<std::size_t>(std::max(0, count)));
  std::partial_sort(hits.begin(),
                    hits.begin() + static_cast<std::ptrdiff_t>(kept),
                    hits.end(),
                    [](const ScanHit& a, const ScanHit& b) {
                      return std::tie(a.squared_distance, a.clip) <
                             std::tie(b.squared_distance, b.clip);
                    });
  hits.resize(kept);
}

}  // namespace marey::library
