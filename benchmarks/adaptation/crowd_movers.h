// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/adaptation/adapt_cases.h"
#include "benchmarks/adaptation/gauss_newton_baseline.h"
#include "benchmarks/adaptation/posture_solver.h"
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// One body of a crowd and what is asked of it.
struct CrowdMember {
  Character character;
  Pose reference;
  CaseClass kind = CaseClass::kNear;
  std::array<glm::dvec3, kCasePoints> targets_in_world{};
  glm::dvec3 com_in_world{0.0};

  [[nodiscard]] PostureTask task() const {
    return {&reference, targets_in_world, com_in_world};
  }
};

/// A way to move a crowd.
class CrowdMover {
 public:
  virtual ~CrowdMover() = default;
  /// Adapts everybody: what is timed. Precondition: the crowd that it was made for, and
  /// one place in `out` per member.
  virtual void move(const std::vector<CrowdMember>& crowd, std::vector<Pose>& out) = 0;
};

/// A column of the tables.
struct CrowdColumn {
  std::string name;
  std::unique_ptr<CrowdMover> mover;
  /// Timed by the wall's clock instead of the thread's own.
  bool has_threads = false;
  double KiB_each = 0.0;  ///< Of memory that the mover took; 0: not known.
  std::vector<Pose> found{};
  std::vector<double> us_each{};  ///< One per round.
};

/// Every baseline and both of marey's methods one by one; then marey's crowds, in every
/// width that this processor has, and with two threads.
[[nodiscard]] std::vector<CrowdColumn> crowd_columns(
    const std::vector<CrowdMember>& crowd,
    const std::vector<PointGoal>& goals,
    bool with_balance);

}  // namespace marey
