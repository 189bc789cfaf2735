// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/duplicates/clip_candidates.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "library/features/body_features.h"

#include "core/base/parallel.h"

namespace marey::library {
namespace {

constexpr std::size_t kAnchorClipBlock = 256;
constexpr std::size_t kMaxQueries = 5;
// Near anchors per query.
constexpr std::size_t kMaxHits = 16;
constexpr float kMaxAnchorDistance = 0.5F;
constexpr double kMaxFirstMismatch = 2.5;
// Limits for copies, and for motions on other bodies.
constexpr double kMaxQuickCopy = 0.6;
constexpr double kMaxQuickDifference = 0.45;
// Same shift of two anchors of a pair of clips. [rows]
constexpr double kSameShift = 1.0;
// Distance of still clips by rounding. [L]
constexpr double kRounding = 0.005;
constexpr int kMinBodyRows = 12;
constexpr double kShortRows = 40.0;
constexpr double kLongRows = 100.0;
constexpr double kShortFactor = 0.67;
// Candidates on other bodies within this factor of the limit are kept, too.
constexpr double kNearFactor = 1.5;

}  // namespace

AnchorTable anchors_of(const ClipRows& features, std::size_t threads) {
  const auto count = static_cast<std::size_t>(features.clip_count());
  const std::size_t blocks = (count + kAnchorClipBlock - 1) / kAnchorClipBlock;
  std::vector<AnchorTable> parts(blocks);
  in_parallel(blocks, threads, [&](std::size_t b) {
    const std::size_t end = std::min(count, (b + 1) * kAnchorClipBlock);
    for (std::size_t c = b * kAnchorClipBlock; c < end; ++c) {
      const MotionAnchors found = find_anchors(features.rows(static_cast<int>(c)));
      AnchorTable& part = parts[b];
      part.values.insert(part.values.end(), found.values.begin(), found.values.end());
      part.at.insert(part.at.end(), found.at.begin(), found.at.end());
      part.clips.insert(part.clips.end(), found.at.size(), static_cast<int>(c));
    }
  });
  AnchorTable out;
  for (AnchorTable& part : parts) {
    out.values.insert(out.values.end(), part.values.begin(), part.values.end());
    out.at.insert(out.at.end(), part.at.begin(), part.at.end());
    out.clips.insert(out.clips.end(), part.clips.begin(), part.clips.end());
    part = {};
  }
  return out;
}

CandidateSearch::CandidateSearch(const ClipRows& features,
                                 const AnchorIndex& index,
                                 const DuplicateRule& rule)
    : features_(features), index_(index), rule_(rule) {}

std::vector<ClipCandidate> CandidateSearch::find(int clip) {
  std::vector<ClipCandidate> out;
  for (const bool is_mirrored : {false, true}) search(clip, is_mirrored, out);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return std::tie(a.original, a.is_mirrored) < std::tie(b.original, b.is_mirrored);
  });
  return out;
}

void CandidateSearch::search(int clip,
                             bool is_mirrored,
                             std::vector<ClipCandidate>& out) {
  std::span<const float> rows = features_.rows(clip);
  std::vector<float> mirrored;
  if (is_mirrored) {
    mirrored = mirrored_features(rows);
    rows = mirrored;
  }
  const MotionAnchors anchors = find_queries(rows, kMaxQueries);
  std::vector<PairShift> pairs;
  for (std::size_t q = 0; q < anchors.at.size(); ++q) {
    index_.find(std::span(anchors.values).subspan(q * kAnchorFloats, kAnchorFloats),
                clip,
                kMaxHits,
                kMaxAnchorDistance,
                anchor_scratch_,
                hits_);
    for (const AnchorHit& hit : hits_) {
      pairs.push_back({index_.table().clips[hit.anchor],
                       index_.table().at[hit.anchor] - anchors.at[q],
                       hit.distance});
    }
  }
  if (pairs.empty()) return;
  std::sort(pairs.begin(), pairs.end(), [](const PairShift& a, const PairShift& b) {
    return std::tie(a.original, a.distance, a.shift) <
           std::tie(b.original, b.distance, b.shift);
  });
  prepare_clip(rows, clip_);
  lengths_ = body_lengths(rows);
  for (std::size_t first = 0; first < pairs.size();) {
    const int original = pairs[first].original;
    const auto last =
        std::find_if(pairs.begin() + static_cast<std::ptrdiff_t>(first),
                     pairs.end(),
                     [&](const PairShift& pair) { return pair.original != original; });
    const auto size = static_cast<std::size_t>(last - pairs.begin()) - first;
    auto best = compare_at(clip, rows, original, std::span(pairs).subspan(first, size));
    first += size;
    if (!best) continue;
    best->is_mirrored = is_mirrored;
    out.push_back(*best);
  }
}

std::optional<ClipCandidate> CandidateSearch::compare_at(
    int clip,
    std::span<const float> rows,
    int original,
    std::span<const PairShift> shifts) {
  const std::span<const float> others = features_.rows(original);
  is_same_body_ = have_same_lengths(lengths_, body_lengths(others));
  const auto count = static_cast<int>(rows.size() / kFeatureStride);
  const auto other_count = static_cast<int>(others.size() / kFeatureStride);
  const double needed = rule_.min_cover_share * std::min(count, other_count) - 1.0;
  // The other clip finds this one.
  if (is_same_body_ && original > clip && other_count <= count) return std::nullopt;
  std::optional<ClipCandidate> best;
  std::vector<double> tried;
  for (const PairShift& pair : shifts) {
    const double shift = pair.shift;
    const double common =
        std::min<double>(count, other_count - shift) - std::max(0.0, -shift);
    if (common < std::max(1.0, needed)) continue;
    if (std::any_of(tried.begin(), tried.end(), [&](double t) {
          return std::abs(t - shift) < kSameShift;
        })) {
      continue;
    }
    const double limit = is_same_body_ ? kMaxQuickCopy : kMaxQuickDifference;
    if (quick_difference(rows, others, shift) > limit) continue;
    if (tried.empty()) prepare_clip(others, other_);
    tried.push_back(shift);
    const auto one = compare(original, shift, needed);
    if (!one) continue;
    if (!best || std::make_tuple(!one->agrees, one->is_other_body, one->course) <
                     std::make_tuple(!best->agrees, best->is_other_body, best->course)) {
      best = one;
    }
  }
  return best;
}

std::optional<ClipCandidate> CandidateSearch::compare(int original,
                                                      double shift,
                                                      double needed) {
  const int shorter = std::min(clip_.count(), other_.count());
  const int longer = std::max(clip_.count(), other_.count());
  const auto agreement =
      compare_clips(clip_, other_, shift, kMaxFirstMismatch, compare_scratch_);
  if (!agreement || agreement->rows < needed) return std::nullopt;
  ClipCandidate out;
  out.original = original;
  out.shift = agreement->shift;
  out.course = agreement->course;
  out.distance = agreement->distance / std::max(agreement->change, 1e-6);
  const bool is_same = shorter + 1.0 >= rule_.min_cover_share * longer &&
                       std::abs(out.shift) <= rule_.max_shift_s * kFeatureRate_hz + 1e-9;
  if (!is_same && shorter == longer) return std::nullopt;
  out.is_contained = !is_same && clip_.count() < other_.count();
  out.agrees = agreement->distance <= kRounding + rule_.max_distance * agreement->change;
  if (out.agrees) return out;
  // Short motions of one kind are too much alike for the full limit.
  const double length_share =
      std::clamp((agreement->rows - kShortRows) / (kLongRows - kShortRows), 0.0, 1.0);
  const double limit =
      rule_.max_body_distance * (kShortFactor + (1.0 - kShortFactor) * length_share);
  if (is_same_body_ || agreement->rows < kMinBodyRows ||
      agreement->course > kNearFactor * limit) {
    return std::nullopt;
  }
  out.is_other_body = true;
  out.agrees = agreement->course <= limit;
  return out;
}

}  // namespace marey::library
