// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: which tags move as one, whatever segments they are declared on.

#include <map>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/sightings.h"

namespace marey::reconstruct {

/// world_from_tag of the tags located in one frame, by position in the subject's list.
using TagPoses = std::map<std::size_t, RigidTransform>;

/// Locates every tag by itself, in at most 160 frames of a trial. Precondition: every
/// joint moves in it, as a body that stands still is rigid as a whole.
[[nodiscard]] std::vector<TagPoses> locate_single_tags(std::span<const Camera> cameras,
                                                       std::span<const TagOnSegment> tags,
                                                       const Sightings& trial);

/// Returns the segment of each of `tags` by their movement: the declared one, except for
/// tags that turn far against the others of their segment and hardly against those of
/// another that is no neighbour.
[[nodiscard]] std::vector<HumanBone> segments_by_rigidity(
    std::span<const TagOnSegment> tags, std::span<const TagPoses> frames);

}  // namespace marey::reconstruct
