// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the segments that tags are really worn on, from their movement.

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "reconstruct/segments/segment_frames.h"

namespace marey::reconstruct {

/// Returns whether two of the segments that tags are worn on share a joint.
[[nodiscard]] bool are_neighbours(HumanBone a, HumanBone b);

/// A new name for each segment that tags were declared on; others keep theirs.
using Renaming = std::map<HumanBone, HumanBone>;

/// Finds the exchange of segments with which neighbours turn about common centres far
/// better than as declared; empty if there is none. Does not detect whole limbs that are
/// exchanged between the sides: see exchanged_limbs().
[[nodiscard]] Renaming exchanged_segments(std::span<const TagCluster> clusters,
                                          std::span<const ClusterPoses> frames);

/// Renames the segments of clusters and of poses.
void rename(const Renaming& names, std::vector<TagCluster>& clusters);
void rename(const Renaming& names, std::vector<ClusterPoses>& frames);

/// Returns an error that names the tags declared on other segments than they are worn on;
/// nullopt if there are none. `worn` is by position in `tags`.
[[nodiscard]] std::optional<Error> exchange_error(std::span<const TagOnSegment> tags,
                                                  std::span<const HumanBone> worn);

}  // namespace marey::reconstruct
