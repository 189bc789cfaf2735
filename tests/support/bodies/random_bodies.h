// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "core/humanoid.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::testing {

/// Repeatable numbers, the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  [[nodiscard]] double between(double low, double high);
  [[nodiscard]] glm::dvec3 direction();
  /// About a random axis, by up to `max_rad`.
  [[nodiscard]] glm::dquat turn(double max_rad);
  /// Approximately normal, zero mean.
  [[nodiscard]] double noise(double sigma);

 private:
  std::mt19937_64 engine_;
};

/// A T-pose humanoid of 1 to 2.5 m whose bones are each 0.75 to 1.3 of average.
[[nodiscard]] Skeleton random_humanoid(Dice& dice);

/// A child of 1.1 m with arms 1.2 times as long, a 2.5 m giant, an adult with long legs
/// and a short trunk.
[[nodiscard]] Skeleton child();
[[nodiscard]] Skeleton giant();
[[nodiscard]] Skeleton long_legs();

/// The same places at rest, every joint's axes turned at random.
[[nodiscard]] Skeleton with_random_axes(const Skeleton& skeleton, Dice& dice);

/// Rests with the arms `down_rad` below the horizontal and the legs half that apart.
[[nodiscard]] Skeleton in_a_pose(const Skeleton& t_pose, double down_rad);

/// The joint taken out, its children hung on its parent; places at rest unchanged.
[[nodiscard]] Skeleton without(const Skeleton& skeleton, HumanBone bone);

/// The vertebrae replaced by `count` unmarked joints, evenly from hips to neck, with the
/// clavicles on the last. Precondition: identity rest rotations, count >= 1.
[[nodiscard]] Skeleton with_vertebrae(const Skeleton& skeleton, int count);

/// Fingers, and a twist joint inside the left upper arm, none of them marked.
[[nodiscard]] Skeleton with_extra_joints(const Skeleton& skeleton);

/// Left and right exchanged: places at rest reflected in X = 0. Identity rest rotations.
[[nodiscard]] Skeleton mirrored_body(const Skeleton& skeleton);

/// Turns every marked joint and every vertebra at random, knees and elbows up to nearly
/// folded; all other joints stay at rest. The root is moved too.
[[nodiscard]] Pose random_pose(const Skeleton& skeleton, Dice& dice);

}  // namespace marey::testing
