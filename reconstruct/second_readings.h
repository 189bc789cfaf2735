// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: limbs that one camera at a time sees by one tag a bone. Such a
// tag has two readings (planar_candidates()), and the covariance at one of them knows
// nothing of the other.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reconstruct/window_solver.h"

namespace marey::reconstruct {

/// Consecutive frames in each of which no more than one camera sees a limb, and no more
/// than one tag of each of its bones; in some of them one is seen.
struct LoneStretch {
  std::size_t limb = 0;  ///< Of human_limbs().
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Finds them in a trial, longer ones than `most_frames` in pieces. By limb, then time.
[[nodiscard]] std::vector<LoneStretch> lone_stretches(const BodyModel& model,
                                                      const Sightings& sightings,
                                                      std::size_t most_frames);

/// What is to be added to the sigma of each limb bone's origin and of each tag for the
/// chance that the other reading is right, in quadrature. [m]
struct ReadingSigmas {
  std::vector<BoneSigmas> bones;  ///< Per frame.
  std::vector<TagSigmas> tags;    ///< Likewise.
};

/// Solves every stretch again from the other readings of each bone's tags, neighbours
/// held, and keeps what explains the sightings better; its covariance is then still that
/// of the first answer. The chances of a limb's three bones add up. Precondition:
/// `windows` has solved `postures`. Cost: that of solving the stretches' frames up to
/// three times more.
[[nodiscard]] ReadingSigmas try_second_readings(const BodyModel& model,
                                                std::span<const Camera> cameras,
                                                const Sightings& sightings,
                                                WindowSolver& windows,
                                                std::vector<Posture>& postures);

}  // namespace marey::reconstruct
