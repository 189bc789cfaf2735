// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/clip_listing.h"

#include <algorithm>
#include <compare>
#include <limits>
#include <utility>

#include "app/library/find/query_clips.h"

namespace marey::app {
namespace {

using recordings::ClipSummary;

constexpr std::size_t kKeptLists = 8;

std::weak_ordering order_by(live::LibrarySort sort,
                            const ClipSummary& a,
                            const ClipSummary& b) {
  switch (sort) {
    case live::LibrarySort::kName:
      return a.name <=> b.name;
    case live::LibrarySort::kSeconds:
      return std::weak_order(a.duration_s, b.duration_s);
    case live::LibrarySort::kRate:
      return std::weak_order(a.rate_hz, b.rate_hz);
    case live::LibrarySort::kQuality:
      return a.quality <=> b.quality;
    case live::LibrarySort::kLicence:
      return a.licence <=> b.licence;
    case live::LibrarySort::kNumber:
      break;
  }
  return a.number <=> b.number;
}

bool are_the_same_list(const live::LibraryListRequest& a,
                       const live::LibraryListRequest& b) {
  return a.query == b.query && a.quality == b.quality && a.sort == b.sort &&
         a.is_descending == b.is_descending;
}

}  // namespace

Result<ClipListing> ClipListing::open(const std::filesystem::path& library) {
  auto clips = recordings::read_clip_summaries(
      library / "library.sqlite", 0, std::numeric_limits<int>::max());
  if (!clips) return clips.error();
  return ClipListing(library, *std::move(clips));
}

std::optional<int> ClipListing::find(std::string_view clip_id) const {
  const auto found = std::ranges::find(clips_, clip_id, &ClipSummary::clip_id);
  if (found == clips_.end()) return std::nullopt;
  return static_cast<int>(found - clips_.begin());
}

Result<FoundClips> ClipListing::evaluate(const live::LibraryListRequest& request) const {
  auto selected = run_clip_query(library_, request.query);
  if (!selected) return selected.error();
  FoundClips out;
  out.remarks = std::move(selected->remarks);
  for (const int number : selected->numbers) {
    // A build may have replaced the index since it was read.
    if (number < 0 || number >= size()) continue;
    const Verdict quality = (*this)[number].quality;
    ++out.counts[static_cast<std::size_t>(quality)];
    if (!request.quality || *request.quality == quality) out.numbers.push_back(number);
  }
  std::ranges::stable_sort(out.numbers, [&](int a, int b) {
    const auto order = order_by(request.sort, (*this)[a], (*this)[b]);
    return request.is_descending ? order > 0 : order < 0;
  });
  return out;
}

Result<const FoundClips*> ClipListing::find(const live::LibraryListRequest& request) {
  const auto known = std::ranges::find_if(
      kept_, [&](const Kept& one) { return are_the_same_list(one.request, request); });
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
    return &kept_.front().found;
  }
  auto found = evaluate(request);
  if (!found) return found.error();
  kept_.push_front({request, *std::move(found)});
  if (kept_.size() > kKeptLists) kept_.pop_back();
  return &kept_.front().found;
}

}  // namespace marey::app
