// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/library/clip_record.h"

namespace marey::library {

/// Clips that one split keeps together, besides duplicates and mirrored copies.
enum class SplitBy {
  kSubject,  ///< All clips of a subject, and all clips of a source.
  kClip,     ///< None: clips of one subject may be in several splits.
};

/// Returns the name of the split of each clip, by a hash and without random numbers.
///
/// Clips form groups: a clip with its duplicate_of and mirror_of, and for kSubject with
/// all clips of its subject and its source. The split of a group follows from a 64-bit
/// hash (FNV-1a, then MurmurHash3's finalizer) of its subjects' names, the smallest one;
/// of its sources without a subject; for kClip of its clips that are neither a duplicate
/// nor a mirrored copy. The order of the records has no influence. A group with subjects
/// keeps its split when clips are added, unless a clip joins two subjects, as a duplicate
/// of one in the other's. Shares are those of groups, on average: few subjects give
/// shares that differ from the wanted ones.
///
/// Linear in clips times their logarithm. Preconditions: shares are not negative and add
/// up to 1, at least one split. Ids that are not among the records are ignored.
[[nodiscard]] std::vector<std::string> split_clips(
    std::span<const ClipRecord> records,
    std::span<const std::pair<std::string, double>> splits,
    SplitBy by);

}  // namespace marey::library
