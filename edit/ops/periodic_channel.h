// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey::edit {

/// Where a cycle lies in a channel of samples, and how its ends are joined.
struct CycleFrame {
  int before = 0;  ///< Samples before the first one of the cycle.
  int frames =
      0;  ///< Samples of the cycle: sample `before + frames` repeats sample `before`.
  int after = 0;  ///< Samples from that one on, itself included; at least 1.
  int blend = 1;  ///< Samples on either side of both ends over which they are blended.
};

/// Makes a channel periodic, in place.
///
/// First the gap of values, last minus first, is removed by a displacement that is linear
/// over the whole cycle: half of the gap at each end, which is the least change. Then the
/// remaining difference around the two ends, r(k) = x(last + k) - x(first + k), whose
/// value at k = 0 is zero and whose slope is the gap of velocities, is removed: half of
/// it on each side, times a weight that is 1 up to one sample from the end and falls to 0
/// at `blend` samples with continuous first and second derivatives.
///
/// So x(last + k) = x(first + k) for k = -1, 0, 1 to rounding: the sample before the
/// cycle's repetition, the repetition and the one after it are three consecutive samples
/// of the source plus a C2 displacement. Differences across the seam (velocity,
/// acceleration) are those of that signal.
///
/// Where samples beyond the cycle's ends are missing, r(-k) = -r(k) is taken from the
/// other side; if both are missing, r(k) = k times the difference of the one-sided
/// slopes, and only value and slope meet. Linear in samples. Precondition: before +
/// frames + after samples; frames >= 2; blend >= 1.
void make_periodic(std::span<glm::dvec3> channel, const CycleFrame& cycle);

/// Makes rotations periodic in the same way: displacements are rotation vectors in the
/// rotated frame, so that the result does not depend on the axes of the parent. Gaps go
/// the shorter way round.
void make_periodic(std::span<glm::dquat> channel, const CycleFrame& cycle);

}  // namespace marey::edit
