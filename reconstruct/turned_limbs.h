// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: limbs that were fitted turned about their own axis. An elbow's
// or a knee's axis is found without its sense: with the other sense the tags sit on the
// other side of both bones, and the joint bends backward. Where a first guess had the
// wrong sense, the bundle ends in a false minimum, bones beside the limb.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/subject_bundle.h"

namespace marey::reconstruct {

/// Returns by how much the limb's upper bone is turned about its own axis against hips or
/// rib cage, in the frames of standing still (median by size); nullopt without such
/// frames. Near 0 in people who stand with arms hanging or held sideways: within 45
/// degrees. [rad]
[[nodiscard]] std::optional<double> standing_turn_rad(std::size_t limb,
                                                      const SubjectBundle& bundle);

/// Solves the two bones of each limb that does not look right (turned while standing, a
/// tag off its skin) again from half a turn about their axes, and keeps what costs less.
/// Tags of extremities are not looked at. Returns the limbs that were turned, in the
/// order of human_limbs(). Limbs without a standing frame are always solved again. Cost:
/// some 0.5 s per limb that is solved again, 2 s more where few frames prefer it turned.
/// Precondition: the bundle was adjusted.
[[nodiscard]] std::vector<std::size_t> turn_limbs(std::span<const Camera> cameras,
                                                  SubjectBundle& bundle);

}  // namespace marey::reconstruct
