// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/find_similar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/search/scan.h"
#include "library/search/warp_distance.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

bool is_nearer(const SimilarMotion& a, const SimilarMotion& b) {
  return std::tie(a.distance, a.clip) < std::tie(b.distance, b.clip);
}

std::span<const float> middle_of(std::span<const float> query,
                                 std::optional<double> length_s) {
  if (!length_s) return query;
  const auto count = static_cast<double>(query.size() / kFeatureStride);
  const double wanted = std::round(std::max(0.0, *length_s) * kFeatureRate_hz) + 1.0;
  if (!(wanted < count)) return query;
  const auto rows = static_cast<std::size_t>(wanted);
  const auto first = (static_cast<std::size_t>(count) - rows) / 2;
  return query.subspan(first * kFeatureStride, rows * kFeatureStride);
}

// First rows of the query's windows: end to end, the last one flush with the end.
std::vector<std::size_t> query_windows(std::size_t count) {
  std::vector<std::size_t> starts;
  for (std::size_t at = 0; at + kWindowRows <= count; at += kWindowRows) {
    starts.push_back(at);
  }
  if (!starts.empty() && starts.back() + kWindowRows < count) {
    starts.push_back(count - kWindowRows);
  }
  return starts;
}

// Scan of all clips; empty: the query has no window.
std::vector<ScanHit> scan_windows(std::span<const float> query, const ClipRows& windows) {
  std::vector<ScanHit> sums;
  for (const std::size_t start : query_windows(query.size() / kFeatureStride)) {
    std::array<float, kWindowFloats> row{};
    project_keys(query.subspan(start * kFeatureStride, kWindowRows * kFeatureStride),
                 kWindowKeys,
                 row);
    const std::vector<ScanHit> hits = nearest_rows(windows, row);
    if (sums.empty()) {
      sums = hits;
      continue;
    }
    for (std::size_t k = 0; k < hits.size(); ++k) {
      sums[k].squared_distance += hits[k].squared_distance;
    }
  }
  return sums;
}

std::vector<int> every_clip(int count) {
  std::vector<int> clips(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < clips.size(); ++k) clips[k] = static_cast<int>(k);
  return clips;
}

bool is_left_out(int clip, const FindSimilarOptions& options) {
  if (options.skipped_clip == clip) return true;
  return options.searched != nullptr &&
         !(*options.searched)[static_cast<std::size_t>(clip)];
}

// Clips in the order in which they are compared exactly. A good order tightens the bound
// early, but does not change the result.
std::vector<int> candidates_of(std::span<const float> query,
                               const SearchRows& library,
                               const FindSimilarOptions& options) {
  std::vector<ScanHit> hits;
  if (options.whole_clips) {
    hits = nearest_rows(library.wholes, whole_clip_row(query));
  } else {
    hits = scan_windows(query, library.windows);
    if (hits.empty()) return every_clip(library.features.clip_count());
  }
  std::erase_if(hits, [&](const ScanHit& h) { return is_left_out(h.clip, options); });
  keep_nearest(hits,
               options.exact ? std::numeric_limits<int>::max() : options.candidates);
  std::vector<int> clips;
  clips.reserve(hits.size());
  for (const ScanHit& hit : hits) clips.push_back(hit.clip);
  return clips;
}

}  // namespace

std::vector<SimilarMotion> find_similar(std::span<const float> query,
                                        const SearchRows& library,
                                        const FindSimilarOptions& options) {
  MAREY_ASSERT(query.size() % kFeatureStride == 0);
  MAREY_ASSERT(library.features.columns == kFeatureStride &&
               library.windows.columns == kWindowFloats &&
               library.wholes.columns == kWholeFloats);
  MAREY_ASSERT(options.searched == nullptr ||
               options.searched->size() ==
                   static_cast<std::size_t>(library.features.clip_count()));
  std::vector<SimilarMotion> found;
  if (query.empty() || options.top <= 0) return found;
  std::vector<float> mirrored;
  if (options.mirror) {
    mirrored = mirrored_features(query);
    query = mirrored;
  }
  query = middle_of(query, options.length_s);
  const WarpEnds ends = options.whole_clips ? WarpEnds::kWhole : WarpEnds::kSubsequence;
  const auto top = static_cast<std::size_t>(options.top);
  WarpScratch scratch;
  double bound = std::numeric_limits<double>::infinity();
  for (const int clip : candidates_of(query, library, options)) {
    if (is_left_out(clip, options)) continue;
    const auto match =
        warp_distance(query, library.features.rows(clip), ends, scratch, bound);
    if (!match) continue;
    const SimilarMotion similar{clip, match->first_row, match->last_row, match->distance};
    found.insert(std::upper_bound(found.begin(), found.end(), similar, is_nearer),
                 similar);
    if (found.size() > top) found.pop_back();
    if (found.size() == top) bound = found.back().distance;
  }
  return found;
}

}  // namespace marey::library
