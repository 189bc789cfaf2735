// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the places of the tags of a hand or foot. They are few, rarely
// seen by two cameras, and a flat tag that one camera sees has two poses. A wrong one has
// such a high cost that it displaces the limb's other joints. Each pose is therefore a
// separate hypothesis, and the limb is solved with each.

#include <cstddef>
#include <span>
#include <vector>

#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

struct ExtremityFit {
  bool placed = false;
  /// Share of its sightings that the best hypothesis explains.
  double explained_share = 0.0;
  int sightings = 0;
  /// The second best hypothesis with another place of the wrist or ankle: its additional
  /// cost (half squares), and its distance, mean over frames. Infinite without one.
  double runner_up_cost = 0.0;
  double runner_up_m = 0.0;
};

/// Finds the place of `tags` (all on the extremity of `limb`) on a bundle whose other
/// tags are placed, and adds them to its model with the limb's lengths, tags and postures
/// refined; leaves the bundle unchanged if no hypothesis explains the sightings. `starts`
/// are further initial values of bone_from_tag of the first tag. Cost: some 0.1 s per
/// hypothesis and 100 frames.
[[nodiscard]] ExtremityFit place_extremity(std::size_t limb,
                                           std::span<const std::size_t> tags,
                                           std::span<const RigidTransform> starts,
                                           std::span<const Camera> cameras,
                                           SubjectBundle& bundle);

}  // namespace marey::reconstruct
