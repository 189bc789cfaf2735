// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/warp_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "library/features/body_features.h"
#include "library/search/row_kernel.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
/// Columns before the first one that are infinite: steps reach two columns back.
constexpr std::size_t kBefore = 2;
/// The sums are floats: a bound is compared with a margin, the result without.
constexpr double kBoundMargin = 1.0 + 1e-5;

// One row of the query against all rows of the clip.
struct WarpRow {
  float* costs = nullptr;  // c(i,j)
  float* sums = nullptr;   // D(i,j)
  int* starts = nullptr;   // First row in the clip of the alignment that ends here.
};

// Views of the scratch memory: three rows of sums and starts, two rows of costs.
struct WarpRows {
  WarpRow now, before, earlier;
};

WarpRows make_rows(WarpScratch& scratch, std::size_t columns) {
  const std::size_t width = columns + kBefore;
  if (scratch.values.size() < 6 * width) scratch.values.resize(6 * width);
  if (scratch.starts.size() < 3 * width) scratch.starts.resize(3 * width);
  std::fill_n(scratch.values.begin(), 6 * width, kInfinite);
  std::fill_n(scratch.starts.begin(), 3 * width, 0);
  const auto row = [&](std::size_t k) {
    return WarpRow{scratch.values.data() + 2 * k * width + kBefore,
                   scratch.values.data() + (2 * k + 1) * width + kBefore,
                   scratch.starts.data() + k * width + kBefore};
  };
  return {row(0), row(1), row(2)};
}

void set_costs(const float* query_row, std::span<const float> clip, WarpRow& row) {
  const std::size_t columns = clip.size() / kFeatureStride;
  static const SquaredDistances distances_of = squared_distances();
  distances_of(clip.data(), columns, kFeatureStride, query_row, row.costs);
  for (std::size_t j = 0; j < columns; ++j) row.costs[j] = std::sqrt(row.costs[j]);
}

void start_alignments(const WarpRow& row, std::size_t columns, WarpEnds ends) {
  const std::size_t count = ends == WarpEnds::kWhole ? 1 : columns;
  for (std::size_t j = 0; j < count; ++j) {
    row.sums[j] = row.costs[j];
    row.starts[j] = static_cast<int>(j);
  }
}

// Computes D(i,j) of all j from the two rows before.
void extend_alignments(const WarpRows& rows, std::ptrdiff_t columns) {
  float* const sums = rows.now.sums;
  int* const starts = rows.now.starts;
  const float* const costs = rows.now.costs;
  const float* const costs_1 = rows.before.costs;
  const float* const sums_1 = rows.before.sums;
  const float* const sums_2 = rows.earlier.sums;
  const int* const starts_1 = rows.before.starts;
  const int* const starts_2 = rows.earlier.starts;
  for (std::ptrdiff_t j = 0; j < columns; ++j) {
    const float straight = sums_1[j - 1];
    const float slow = sums_2[j - 1] + costs_1[j];
    const float fast = sums_1[j - 2] + costs[j - 1];
    const bool is_slow = slow < straight;
    const float first = is_slow ? slow : straight;
    const int first_start = is_slow ? starts_2[j - 1] : starts_1[j - 1];
    const bool is_fast = fast < first;
    sums[j] = (is_fast ? fast : first) + costs[j];
    starts[j] = is_fast ? starts_1[j - 2] : first_start;
  }
}

float least_sum(const WarpRow& row, std::size_t columns) {
  float least = kInfinite;
  for (std::size_t j = 0; j < columns; ++j) {
    least = row.sums[j] < least ? row.sums[j] : least;
  }
  return least;
}

}  // namespace

std::optional<WarpMatch> warp_distance(std::span<const float> query,
                                       std::span<const float> clip,
                                       WarpEnds ends,
                                       WarpScratch& scratch,
                                       double max_distance) {
  MAREY_ASSERT(!query.empty() && query.size() % kFeatureStride == 0 &&
               clip.size() % kFeatureStride == 0);
  const std::size_t count = query.size() / kFeatureStride;
  const std::size_t columns = clip.size() / kFeatureStride;
  // Each row of the clip is reached by at most two rows of the query, and the first one
  // by one only.
  if (columns == 0 || count > 2 * columns - 1) return std::nullopt;
  if (ends == WarpEnds::kWhole && columns > 2 * count - 1) return std::nullopt;
  const double unit =
      static_cast<double>(ends == WarpEnds::kWhole ? std::max(count, columns) : count);
  const double max_sum = max_distance * unit * kBoundMargin;

  WarpRows rows = make_rows(scratch, columns);
  for (std::size_t i = 0; i < count; ++i) {
    set_costs(query.data() + i * kFeatureStride, clip, rows.now);
    if (i == 0) {
      start_alignments(rows.now, columns, ends);
    } else {
      extend_alignments(rows, static_cast<std::ptrdiff_t>(columns));
    }
    const float least = least_sum(rows.now, columns);
    // No alignment has a lower sum at this row of the query, not even one that passes it
    // within a step (2,1): D(i,j) is the least of these sums, too.
    if (least == kInfinite || static_cast<double>(least) > max_sum) return std::nullopt;
    if (i + 1 < count) rows = {rows.earlier, rows.now, rows.before};
  }
  std::size_t end = columns - 1;
  if (ends == WarpEnds::kSubsequence) {
    end = static_cast<std::size_t>(
        std::min_element(rows.now.sums, rows.now.sums + columns) - rows.now.sums);
  }
  const float sum = rows.now.sums[end];
  const double distance = static_cast<double>(sum) / unit;
  if (sum == kInfinite || distance > max_distance) return std::nullopt;
  return WarpMatch{distance, rows.now.starts[end], static_cast<int>(end)};
}

}  // namespace marey::library
