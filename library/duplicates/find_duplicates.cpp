// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/duplicates/find_duplicates.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <tuple>

#include "library/duplicates/clip_candidates.h"
#include "library/features/body_features.h"

#include "core/base/assert.h"
#include "core/base/parallel.h"

namespace marey::library {
namespace {

// Clips that one thread takes at a time.
constexpr std::size_t kClipBlock = 64;
// A distinct match on another body: the next one differs by this factor.
constexpr double kDistinct = 1.25;

// Smaller: the better original.
auto rank(const ClipCandidate& candidate) {
  return std::make_tuple(candidate.is_other_body,
                         candidate.is_mirrored,
                         candidate.distance,
                         candidate.original);
}

/// Chooses the original of each clip from all candidates.
class OriginalChoice {
 public:
  OriginalChoice(const ClipRows& features,
                 std::vector<std::vector<ClipCandidate>> candidates)
      : features_(features),
        candidates_(std::move(candidates)),
        chosen_(candidates_.size()) {}

  std::vector<DuplicateClip> choose() {
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const ClipCandidate* best = nullptr;
      for (const ClipCandidate& one : candidates_[c]) {
        if (!one.agrees || !may_stay(one.original, static_cast<int>(c))) continue;
        if (best == nullptr || rank(one) < rank(*best)) best = &one;
      }
      if (best != nullptr) chosen_[c] = *best;
    }
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (chosen_[c] && chosen_[c]->is_other_body && !is_distinct(static_cast<int>(c))) {
        chosen_[c].reset();
      }
    }
    std::vector<DuplicateClip> out;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (chosen_[c]) out.push_back(resolved(static_cast<int>(c)));
    }
    return out;
  }

 private:
  // The clip with more rows stays; of equally long ones, the first. A tolerance of the
  // lengths would not be transitive: then three clips can be originals in a circle, and
  // no copy remains.
  [[nodiscard]] bool may_stay(int original, int clip) const {
    const auto rows = features_.row_count(original);
    const auto own_rows = features_.row_count(clip);
    return rows != own_rows ? rows > own_rows : original < clip;
  }

  [[nodiscard]] bool are_related(int a, int b) const {
    const auto links = [&](int from, int to) {
      const auto& list = candidates_[static_cast<std::size_t>(from)];
      return std::any_of(list.begin(), list.end(), [&](const ClipCandidate& one) {
        return one.agrees && !one.is_other_body && one.original == to;
      });
    };
    return a == b || links(a, b) || links(b, a);
  }

  [[nodiscard]] bool is_distinct(int clip) const {
    const ClipCandidate& best = *chosen_[static_cast<std::size_t>(clip)];
    for (const ClipCandidate& one : candidates_[static_cast<std::size_t>(clip)]) {
      if (one.original == best.original || one.is_mirrored != best.is_mirrored) continue;
      if (!one.is_other_body || one.course > kDistinct * best.course) continue;
      if (!are_related(one.original, best.original)) return false;
    }
    return true;
  }

  [[nodiscard]] DuplicateClip resolved(int clip) const {
    const ClipCandidate& first = *chosen_[static_cast<std::size_t>(clip)];
    DuplicateClip out{clip,
                      first.original,
                      first.is_mirrored,
                      first.is_contained,
                      first.shift / kFeatureRate_hz,
                      first.distance};
    // Ends, since each step leads to a clip that may_stay() prefers.
    while (const auto& next = chosen_[static_cast<std::size_t>(out.original)]) {
      out.original = next->original;
      out.is_mirrored = out.is_mirrored != next->is_mirrored;
      out.is_contained = out.is_contained || next->is_contained;
      out.shift_s += next->shift / kFeatureRate_hz;
    }
    return out;
  }

  const ClipRows& features_;
  std::vector<std::vector<ClipCandidate>> candidates_;
  std::vector<std::optional<ClipCandidate>> chosen_;
};

// Adds the first clip with the same rows as a candidate, which needs no movement.
void add_equal_clips(const ClipRows& features,
                     std::vector<std::vector<ClipCandidate>>& candidates) {
  std::vector<int> order(candidates.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
  const auto compare = [&](int a, int b) {
    const auto x = features.rows(a);
    const auto y = features.rows(b);
    if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
    return x.empty() ? 0 : std::memcmp(x.data(), y.data(), x.size_bytes());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const int difference = compare(a, b);
    return difference != 0 ? difference < 0 : a < b;
  });
  for (std::size_t k = 0; k < order.size();) {
    const int first = order[k];
    for (++k; k < order.size() && compare(first, order[k]) == 0; ++k) {
      if (features.row_count(first) == 0) continue;
      ClipCandidate equal;
      equal.original = first;
      equal.agrees = true;
      candidates[static_cast<std::size_t>(order[k])].push_back(equal);
    }
  }
}

}  // namespace

std::vector<DuplicateClip> find_duplicates(const ClipRows& features,
                                           const DuplicateRule& rule,
                                           std::size_t threads) {
  MAREY_ASSERT(features.columns == kFeatureStride);
  const auto count = static_cast<std::size_t>(features.clip_count());
  const AnchorIndex index(anchors_of(features, threads), threads);
  std::vector<std::vector<ClipCandidate>> candidates(count);
  const std::size_t blocks = (count + kClipBlock - 1) / kClipBlock;
  in_parallel(blocks, threads, [&](std::size_t b) {
    CandidateSearch search(features, index, rule);
    for (std::size_t c = b * kClipBlock; c < std::min(count, (b + 1) * kClipBlock); ++c) {
      candidates[c] = search.find(static_cast<int>(c));
    }
  });
  add_equal_clips(features, candidates);
  return OriginalChoice(features, std::move(candidates)).choose();
}

}  // namespace marey::library
