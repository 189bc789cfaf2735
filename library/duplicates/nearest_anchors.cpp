// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/duplicates/nearest_anchors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "library/duplicates/motion_anchors.h"
#include "library/search/row_kernel.h"

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace marey::library {
namespace {

constexpr std::size_t kColumns = kAnchorFloats;
constexpr std::size_t kMinClustered = 8192;
constexpr double kClusterFactor = 3.0;
// Anchors that one thread takes at a time.
constexpr std::size_t kAnchorBlock = 1024;
// Rows whose distances are computed at once.
constexpr std::size_t kRowBlock = 512;
// Above the rounding of a square root and its square.
constexpr float kSquareMargin = 1.00001F;

std::size_t cluster_count(std::size_t anchors) {
  if (anchors < kMinClustered) return 1;
  return static_cast<std::size_t>(kClusterFactor *
                                  std::sqrt(static_cast<double>(anchors)));
}

std::vector<std::size_t> nearest_centres(const AnchorTable& table,
                                         std::span<const float> centres,
                                         std::size_t threads) {
  const SquaredDistances distances_of = squared_distances();
  std::vector<std::size_t> out(table.count(), 0);
  if (centres.size() == kColumns) return out;
  const std::size_t blocks = (table.count() + kAnchorBlock - 1) / kAnchorBlock;
  in_parallel(blocks, threads, [&](std::size_t b) {
    std::vector<float> squares(centres.size() / kColumns);
    const std::size_t end = std::min(table.count(), (b + 1) * kAnchorBlock);
    for (std::size_t k = b * kAnchorBlock; k < end; ++k) {
      distances_of(
          centres.data(), squares.size(), kColumns, table.row(k).data(), squares.data());
      out[k] = static_cast<std::size_t>(std::min_element(squares.begin(), squares.end()) -
                                        squares.begin());
    }
  });
  return out;
}

bool is_nearer_hit(const AnchorHit& a, const AnchorHit& b) {
  return std::tie(a.distance, a.anchor) < std::tie(b.distance, b.anchor);
}

// `hits` is a heap with the farthest hit in front.
void add_hit(const AnchorHit& hit, std::size_t count, std::vector<AnchorHit>& hits) {
  if (hits.size() == count) {
    if (!is_nearer_hit(hit, hits.front())) return;
    std::pop_heap(hits.begin(), hits.end(), is_nearer_hit);
    hits.pop_back();
  }
  hits.push_back(hit);
  std::push_heap(hits.begin(), hits.end(), is_nearer_hit);
}

}  // namespace

std::span<const float> AnchorTable::row(std::size_t k) const {
  return std::span(values).subspan(k * kColumns, kColumns);
}

AnchorIndex::AnchorIndex(AnchorTable table, std::size_t threads) {
  const std::size_t count = table.count();
  MAREY_ASSERT(table.values.size() == count * kColumns && table.at.size() == count);
  const std::size_t clusters = cluster_count(count);
  for (std::size_t k = 0; k < clusters && count > 0; ++k) {
    const auto row = table.row(k * count / clusters);
    centres_.insert(centres_.end(), row.begin(), row.end());
  }
  const std::vector<std::size_t> cluster_of = nearest_centres(table, centres_, threads);
  begins_.assign(clusters + 1, 0);
  for (const std::size_t c : cluster_of) ++begins_[c + 1];
  for (std::size_t c = 0; c < clusters; ++c) begins_[c + 1] += begins_[c];
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  table_.values.resize(table.values.size());
  table_.clips.resize(count);
  table_.at.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t to = next[cluster_of[k]]++;
    const auto row = table.row(k);
    std::copy(row.begin(),
              row.end(),
              table_.values.begin() + static_cast<std::ptrdiff_t>(to * kColumns));
    table_.clips[to] = table.clips[k];
    table_.at[to] = table.at[k];
  }
}

void AnchorIndex::find(std::span<const float> query,
                       int skipped_clip,
                       std::size_t count,
                       float max_distance,
                       AnchorScratch& scratch,
                       std::vector<AnchorHit>& out) const {
  MAREY_ASSERT(query.size() == kColumns);
  out.clear();
  if (table_.count() == 0 || count == 0) return;
  const SquaredDistances distances_of = squared_distances();
  const std::size_t clusters = begins_.size() - 1;
  scratch.distances.resize(clusters);
  distances_of(
      centres_.data(), clusters, kColumns, query.data(), scratch.distances.data());
  scratch.clusters.resize(clusters);
  for (std::size_t c = 0; c < clusters; ++c) {
    scratch.clusters[c] = {scratch.distances[c], c};
  }
  const std::size_t searched = std::min(kSearchedClusters, clusters);
  std::partial_sort(scratch.clusters.begin(),
                    scratch.clusters.begin() + static_cast<std::ptrdiff_t>(searched),
                    scratch.clusters.end());
  float max_square = max_distance * max_distance;
  std::array<float, kRowBlock> squares{};
  for (std::size_t n = 0; n < searched; ++n) {
    const std::size_t c = scratch.clusters[n].second;
    for (std::size_t first = begins_[c]; first < begins_[c + 1]; first += kRowBlock) {
      const std::size_t size = std::min(kRowBlock, begins_[c + 1] - first);
      distances_of(table_.values.data() + first * kColumns,
                   size,
                   kColumns,
                   query.data(),
                   squares.data());
      for (std::size_t k = 0; k < size; ++k) {
        if (squares[k] > max_square || table_.clips[first + k] == skipped_clip) continue;
        add_hit({first + k, std::sqrt(squares[k])}, count, out);
        if (out.size() == count) {
          max_square = std::min(
              max_square, out.front().distance * out.front().distance * kSquareMargin);
        }
      }
    }
  }
  std::sort(out.begin(), out.end(), is_nearer_hit);
}

}  // namespace marey::library
