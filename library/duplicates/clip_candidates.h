// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "library/duplicates/compare_clips.h"
#include "library/duplicates/motion_anchors.h"
#include "library/duplicates/nearest_anchors.h"
#include "library/search/clip_rows.h"

#include "core/library/library_settings.h"

namespace marey::library {

/// Another clip that may be the original of a clip.
struct ClipCandidate {
  int original = 0;
  bool agrees = false;         ///< It fulfils the rule, but for being distinct.
  bool is_mirrored = false;    ///< The clip was compared as its mirror image.
  bool is_contained = false;   ///< A part of the original.
  bool is_other_body = false;  ///< It agrees, or is near, by its course only.
  double shift = 0.0;          ///< Row of the original at the clip's first row.
  double distance = 0.0;       ///< Over the change within 0.1 s.
  double course = 0.0;         ///< ClipAgreement::course.
};

/// A pair of clips at a time shift.
struct PairShift {
  int original = 0;
  double shift = 0.0;  ///< Row of the original at the clip's first row.
  float distance = 0.0F;
};

/// Returns the anchors of all clips. The same for any number of threads. Linear in rows.
[[nodiscard]] AnchorTable anchors_of(const ClipRows& features, std::size_t threads);

/// Search for the candidates of one clip after the other, plain and mirrored. One per
/// thread. The referenced objects must outlive it.
class CandidateSearch {
 public:
  CandidateSearch(const ClipRows& features,
                  const AnchorIndex& index,
                  const DuplicateRule& rule);

  /// Returns the clips that agree with a clip or, on other bodies, are near it: see
  /// find_duplicates(). Ascending by original, unmirrored first.
  [[nodiscard]] std::vector<ClipCandidate> find(int clip);

 private:
  void search(int clip, bool is_mirrored, std::vector<ClipCandidate>& out);
  [[nodiscard]] std::optional<ClipCandidate> compare_at(
      int clip,
      std::span<const float> rows,
      int original,
      std::span<const PairShift> shifts);
  [[nodiscard]] std::optional<ClipCandidate> compare(int original,
                                                     double shift,
                                                     double needed);

  const ClipRows& features_;
  const AnchorIndex& index_;
  const DuplicateRule& rule_;
  ComparedClip clip_, other_;
  BodyLengths lengths_{};
  bool is_same_body_ = false;
  AnchorScratch anchor_scratch_;
  CompareScratch compare_scratch_;
  std::vector<AnchorHit> hits_;
};

}  // namespace marey::library
