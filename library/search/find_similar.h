// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "library/search/clip_rows.h"

namespace marey::library {

/// Views of the search files of a library. Each has all clips in the same order.
struct SearchRows {
  ClipRows features;  ///< body_features(): columns = kFeatureStride.
  ClipRows windows;   ///< feature_windows(): columns = kWindowFloats.
  ClipRows wholes;    ///< whole_clip_row(): columns = kWholeFloats; a row per clip.
};

struct FindSimilarOptions {
  int top = 10;  ///< Maximum number of clips returned.
  /// Searches for the mirror image of the query.
  bool mirror = false;
  /// Computes the exact distance of every clip, instead of the nearest `candidates`.
  bool exact = false;
  /// Compares whole clips with the whole query, instead of parts of clips.
  bool whole_clips = false;
  /// Uses only the middle of a longer query. nullopt: all of it. [s]
  std::optional<double> length_s;
  /// Clips whose exact distance is computed after the scan.
  int candidates = 800;
  /// A clip that is left out: the query's own.
  std::optional<int> skipped_clip;
  /// The clips that are searched, true by number; nullptr: all. An entry per clip.
  const std::vector<bool>* searched = nullptr;
};

/// A part of a clip that is similar to the query.
struct SimilarMotion {
  int clip = 0;
  int first_row = 0;  ///< Row of the features. Time: BodyFeatures::start_s
  int last_row = 0;   ///< plus 0.1 s per row. Included.
  /// Mean distance of aligned rows of features (library/search/warp_distance.h).
  double distance = 0.0;
};

/// Finds the clips that are most similar to a query, the best part of each. Ascending by
/// distance, then by clip.
///
/// A scan compares the query's windows of 2 s with the windows of the clips (or whole
/// clips with whole clips), and warp_distance() of the nearest `candidates` gives the
/// order. A query longer than 2 s is cut into windows of 2 s, the last one flush with its
/// end; the squared distances of a clip's nearest windows are added. A query shorter than
/// 2 s has no window: all clips are compared exactly, as with `exact`. Clips that cannot
/// be aligned with at most twofold stretch are not returned.
///
/// Deterministic; one thread. Cost per 10 h of clips, on one core: see
/// docs/accuracy/library.md. Precondition: `query` has rows of kFeatureStride floats.
[[nodiscard]] std::vector<SimilarMotion> find_similar(
    std::span<const float> query,
    const SearchRows& library,
    const FindSimilarOptions& options = {});

}  // namespace marey::library
