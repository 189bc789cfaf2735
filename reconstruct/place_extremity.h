// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: where the tags of a hand or foot sit. They are few, seldom seen
// by two cameras, and a flat tag that one camera sees has two readings: a wrong one costs
// so much that it drags the limb's other joints along. So each reading is a hypothesis of
// its own, and the limb is solved with each.

#include <cstddef>
#include <span>
#include <vector>

#include "reconstruct/subject_bundle.h"

namespace marey::reconstruct {

struct ExtremityFit {
  bool placed = false;
  /// Share of its sightings that the best hypothesis explains.
  double explained_share = 0.0;
  int sightings = 0;
  /// The next best hypothesis that puts the wrist or ankle elsewhere: by how much more it
  /// costs (half squares), and how far away it is, mean over frames. Infinite without.
  double runner_up_cost = 0.0;
  double runner_up_m = 0.0;
};

/// Finds the place of `tags` (all on the extremity of `limb`) on a bundle whose other
/// tags are placed, and adds them to its model with the limb's lengths, tags and postures
/// refined; leaves the bundle as it was when no hypothesis explains the sightings.
/// `starts` are further guesses of bone_from_tag of the first tag.
/// Cost: some 0.1 s per hypothesis and 100 frames.
[[nodiscard]] ExtremityFit place_extremity(std::size_t limb,
                                           std::span<const std::size_t> tags,
                                           std::span<const RigidTransform> starts,
                                           std::span<const Camera> cameras,
                                           SubjectBundle& bundle);

}  // namespace marey::reconstruct
