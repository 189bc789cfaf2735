// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey {

/// The general-purpose solver that an adapter has to be better than: damped Gauss-Newton
/// steps on every joint as a ball joint and on the root's place, by the Jacobian's small
/// side (J^T (J J^T + d I)^-1 e). One page, no thought for bodies.
enum class BaselineKind {
  kDualFloat,     ///< One weighted sum: a planted point counts five times.
  kDualDouble,    ///< The same.
  kStrictDouble,  ///< Planted points and the centre of mass first, the rest in the null
                  ///< space; at last the root is moved so that the feet stand exactly.
};

/// A joint that is wanted somewhere.
struct PointGoal {
  JointIndex joint{};
  bool is_planted = false;
};

/// Stops when every point, and the centre of mass if it is asked for, is within 1 mm, or
/// when nothing gets better, or after 50 steps. Allocates nothing once it has solved.
class GaussNewtonBaseline {
 public:
  /// Precondition: the first joint is the only root. `masses`' sum is positive if
  /// `with_balance`, and then the horizontal place of the centre of mass is adapted too.
  [[nodiscard]] static std::unique_ptr<GaussNewtonBaseline> make(
      BaselineKind kind,
      const Skeleton& skeleton,
      const std::vector<PointMass>& masses,
      std::span<const PointGoal> goals,
      bool with_balance);
  virtual ~GaussNewtonBaseline() = default;

  /// Where it starts from. Not part of the solver proper: a posture in its own numbers.
  virtual void load(const Pose& reference) = 0;
  /// Steps made. `targets_in_world` is as long as the goals; `com_in_world` is looked at
  /// only with balance.
  virtual int solve(std::span<const glm::dvec3> targets_in_world,
                    const glm::dvec3& com_in_world) = 0;
  /// The posture found, in everybody's numbers.
  virtual void store(Pose& out) const = 0;
};

}  // namespace marey
