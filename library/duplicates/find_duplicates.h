// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "library/search/clip_rows.h"

#include "core/library/library_settings.h"

namespace marey::library {

/// A clip whose motion another clip of the library has, too.
struct DuplicateClip {
  int clip = 0;
  int original = 0;
  /// The clip is the mirror image of its original.
  bool is_mirrored = false;
  /// The clip is a part of its original, which is longer by more than a tenth or begins
  /// earlier by more than DuplicateRule::max_shift_s.
  bool is_contained = false;
  /// Start of the clip's features in those of its original. [s]
  double shift_s = 0.0;
  /// Mean distance of the features over the mean change of the features within 0.1 s.
  double distance = 0.0;
};

/// Finds the clips that repeat another one: the same motion in another file, at another
/// rate or on another skeleton, a part of a longer clip, or a mirror image of either. At
/// most one entry per clip, ascending by clip. The clip with fewer rows is the duplicate,
/// also if the other one is later. If both have equally many rows, the later one is. The
/// most similar one of several originals counts, unmirrored before mirrored. If that one
/// is a duplicate itself, its original counts: no original is a duplicate, and one copy
/// always remains.
///
/// The features of both clips, without the height of the hips (compare_clips()), must
/// agree over `rule.min_cover_share` of the shorter clip. Agreement is one of:
///
/// - The mean distance is at most 0.005 + rule.max_distance times the mean change of the
///   features within 0.1 s. A copy at another rate, or a cut between two instants of
///   the features, differs by a part of a row. A repetition of a motion by the same
///   person differs by more (docs/accuracy/library_duplicates.md).
/// - The bodies have other lengths, 1.2 s or more are common, and the courses
///   (ClipAgreement::course) differ by at most rule.max_body_distance over 10 s or more,
///   0.67 times that over 4 s or less. The nearest other clip that is no duplicate of the
///   original differs by 1.25 times as much.
///
/// Candidates come from the anchors of the clips (library/duplicates/motion_anchors.h),
/// not from all pairs. Clips without movement are compared only if all their features are
/// equal.
///
/// The same result for any number of threads. Cost: clips times sqrt(clips), figures in
/// docs/accuracy/library_duplicates.md. Memory: about 350 bytes per anchor; clips
/// have two or three anchors per second. Precondition: rows of kFeatureStride floats.
[[nodiscard]] std::vector<DuplicateClip> find_duplicates(const ClipRows& features,
                                                         const DuplicateRule& rule = {},
                                                         std::size_t threads = 1);

}  // namespace marey::library
