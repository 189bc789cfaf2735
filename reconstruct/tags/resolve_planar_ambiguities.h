// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: planar ambiguity of limbs that one camera at a time sees by one
// tag per bone. Such a tag has two poses that fit (planar_candidates()). The covariance
// at one of them does not include the other.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reconstruct/tags/window_solver.h"

namespace marey::reconstruct {

/// A run of consecutive frames. In each, at most one camera sees the limb, and at most
/// one tag of each of its bones; in some of them a tag is seen.
struct SingleViewInterval {
  std::size_t limb = 0;  ///< Index in human_limbs().
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Finds these intervals in a trial and splits those longer than `max_frames`. Sorted by
/// limb, then by time.
[[nodiscard]] std::vector<SingleViewInterval> single_view_intervals(
    const BodyModel& model, const Sightings& sightings, std::size_t max_frames);

/// Additional sigma of each limb bone's origin and of each tag for the probability that
/// the other pose is right. Added in quadrature. [m]
struct AmbiguitySigmas {
  std::vector<BoneSigmas> bones;  ///< Per frame.
  std::vector<TagSigmas> tags;    ///< Per frame.
};

/// Solves every interval again from the other poses of each bone's tags, with the
/// neighbouring frames held, and keeps the solution that explains the sightings better.
/// The covariance remains that of the first solution. The probabilities of a limb's three
/// bones add up. Precondition: `windows` has solved `postures`. Cost: that of solving the
/// intervals' frames up to three more times.
[[nodiscard]] AmbiguitySigmas resolve_planar_ambiguities(const BodyModel& model,
                                                         std::span<const Camera> cameras,
                                                         const Sightings& sightings,
                                                         WindowSolver& windows,
                                                         std::vector<Posture>& postures);

}  // namespace marey::reconstruct
