// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: limbs that were fitted turned about their own axis. An elbow's
// or a knee's axis is found without its sign: with the opposite sign the tags sit on the
// other side of both bones, and the joint bends backward. If the initial sign was wrong,
// the bundle ends in a false minimum, with bones next to the limb.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

/// Returns the turn of the limb's upper bone about its own axis relative to hips or rib
/// cage, in the frames of standing still (median by size); nullopt without such frames.
/// In people who stand with arms hanging or held sideways it is near 0: within 45
/// degrees. [rad]
[[nodiscard]] std::optional<double> standing_turn_rad(std::size_t limb,
                                                      const SubjectBundle& bundle);

/// Solves the two bones of each implausible limb (turned while standing, a tag off its
/// skin) again after half a turn about their axes, and keeps the solution with the lower
/// cost. Tags of extremities are ignored. Returns the limbs that were turned, in the
/// order of human_limbs(). Limbs without a standing frame are always solved again. Cost:
/// some 0.5 s per limb that is solved again, 2 s more if few frames prefer it turned.
/// Precondition: the bundle was adjusted.
[[nodiscard]] std::vector<std::size_t> turn_limbs(std::span<const Camera> cameras,
                                                  SubjectBundle& bundle);

}  // namespace marey::reconstruct
