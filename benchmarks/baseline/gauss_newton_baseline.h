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

/// The kind of general-purpose solver that serves as the baseline for the adapters. It
/// makes damped Gauss-Newton steps on every joint as a ball joint and on the position of
/// the root, with the smaller normal matrix (J^T (J J^T + d I)^-1 e). It uses no
/// knowledge of human bodies.
enum class BaselineKind {
  kDualFloat,     ///< One weighted sum: a planted point counts five times.
  kDualDouble,    ///< The same in double precision.
  kStrictDouble,  ///< Planted points and the centre of mass first, the rest in the null
                  ///< space. A final shift of the root places the feet exactly.
};

/// A joint that has a target position.
struct PointGoal {
  JointIndex joint{};
  bool is_planted = false;
};

/// Stops when every point (with balance, also the centre of mass) is within 1 mm, when
/// the error no longer decreases, or after 50 steps (kStrictDouble: 48). It allocates no
/// memory after the first solve().
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

  /// Sets the start posture, converted to the solver's number type. The conversion is not
  /// part of solve().
  virtual void load(const Pose& reference) = 0;
  /// Returns the number of steps. `targets_in_world` is as long as the goals;
  /// `com_in_world` is used only with balance.
  virtual int solve(std::span<const glm::dvec3> targets_in_world,
                    const glm::dvec3& com_in_world) = 0;
  /// Writes the posture found, converted to a Pose.
  virtual void store(Pose& out) const = 0;
};

}  // namespace marey
