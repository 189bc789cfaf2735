// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: groups of tags that move as one, independent of their declared
// segments.

#include <map>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {

/// world_from_tag of the tags located in one frame, by position in the subject's list.
using TagPoses = std::map<std::size_t, RigidTransform>;

/// Locates every tag separately, in at most 160 frames of a trial. Precondition: every
/// joint moves in it, because a body that stands still is rigid as a whole.
[[nodiscard]] std::vector<TagPoses> locate_single_tags(std::span<const Camera> cameras,
                                                       std::span<const TagOnSegment> tags,
                                                       const Sightings& trial);

/// Returns the segment of each of `tags` by their movement: the declared one, except for
/// tags that turn far relative to the others of their segment and hardly relative to
/// those of another that is not a neighbour.
[[nodiscard]] std::vector<HumanBone> segments_by_rigidity(
    std::span<const TagOnSegment> tags, std::span<const TagPoses> frames);

}  // namespace marey::reconstruct
