// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace marey::library {

/// Anchors of many clips, kAnchorFloats per anchor.
struct AnchorTable {
  std::vector<float> values;
  std::vector<int> clips;  ///< Clip of each anchor.
  std::vector<double> at;  ///< Row of each anchor in its clip.

  [[nodiscard]] std::size_t count() const { return clips.size(); }
  [[nodiscard]] std::span<const float> row(std::size_t k) const;
};

/// An anchor near a query.
struct AnchorHit {
  std::size_t anchor = 0;  ///< In the table.
  float distance = 0.0F;
};

/// Memory of a search that is used again. One per thread.
struct AnchorScratch {
  std::vector<float> distances;
  std::vector<std::pair<float, std::size_t>> clusters;
};

/// Search for near anchors. Tables of 8192 anchors or more are divided into
/// 3 sqrt(anchors) clusters around some of the anchors, and a query searches the nearest
/// kSearchedClusters: so an anchor near a border may be missed.
/// benchmarks/library/measure_duplicates.cpp measures how many copies are found.
class AnchorIndex {
 public:
  static constexpr std::size_t kSearchedClusters = 10;

  /// The same clusters for any number of threads. Cost: anchors times sqrt(anchors).
  /// Memory: twice the table.
  AnchorIndex(AnchorTable table, std::size_t threads);

  /// Finds the nearest anchors of other clips than `skipped_clip`: at most `count`, and
  /// none beyond `max_distance`. Ascending by distance, then by anchor; replaces `out`.
  /// Precondition: `query` has kAnchorFloats.
  void find(std::span<const float> query,
            int skipped_clip,
            std::size_t count,
            float max_distance,
            AnchorScratch& scratch,
            std::vector<AnchorHit>& out) const;

  [[nodiscard]] const AnchorTable& table() const { return table_; }

 private:
  AnchorTable table_;  // In the order of the clusters.
  std::vector<float> centres_;
  std::vector<std::size_t> begins_;  // First anchor of each cluster; last, all.
};

}  // namespace marey::library
