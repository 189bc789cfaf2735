// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/clip_neighbours.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "library/features/body_features.h"
#include "library/search/find_similar.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Clips whose exact distance is computed. The page shows few neighbours, so fewer
/// suffice than for a search of ten (docs/accuracy/library.md).
constexpr int kCandidates = 400;

}  // namespace

Result<ClipNeighbours> ClipNeighbours::open(const fs::path& library, int clip_count) {
  auto search = open_search(library);
  if (!search) return search.error();
  if (search->rows().features.clip_count() != clip_count) {
    return bad_input(library.string(),
                     "the library was built again meanwhile",
                     "look at the page again in a moment");
  }
  return ClipNeighbours(*std::move(search));
}

FoundNeighbours ClipNeighbours::find(int clip, bool is_mirrored, int count) const {
  const library::SearchRows rows = search_.rows();
  FoundNeighbours out;
  std::span<const float> query = rows.features.rows(clip);
  if (query.empty()) return out;
  constexpr std::size_t kMaxFloats = std::size_t{kMaxQueryRows} * library::kFeatureStride;
  query = query.first(std::min(query.size(), kMaxFloats));
  out.compared_rows = static_cast<int>(query.size() / library::kFeatureStride);
  library::FindSimilarOptions options;
  options.top = count;
  options.mirror = is_mirrored;
  options.candidates = kCandidates;
  options.skipped_clip = clip;
  for (const auto& found : library::find_similar(query, rows, options)) {
    out.clips.push_back({found.clip, found.distance, found.first_row, found.last_row});
  }
  return out;
}

double first_row_s(int first_frame, double rate_hz) {
  const double first_s = first_frame / rate_hz;
  constexpr double kRounding = 1e-9;
  const double row = std::ceil(first_s * library::kFeatureRate_hz - kRounding);
  return std::max(0.0, row / library::kFeatureRate_hz - first_s);
}

}  // namespace marey::app
