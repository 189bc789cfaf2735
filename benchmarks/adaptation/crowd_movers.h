// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "benchmarks/adaptation/adapt_cases.h"
#include "benchmarks/adaptation/posture_solver.h"
#include "benchmarks/baseline/gauss_newton_baseline.h"
#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// One body of a crowd and its task.
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
  /// Adapts all members. The benchmark times this call. Precondition: `crowd` is the
  /// crowd that the mover was made for, and `out` has one element per member.
  virtual void move(const std::vector<CrowdMember>& crowd, std::vector<Pose>& out) = 0;
};

/// A column of the tables.
struct CrowdColumn {
  std::string name;
  std::unique_ptr<CrowdMover> mover;
  /// Timed by wall-clock time instead of the thread's processor time.
  bool has_threads = false;
  double KiB_each = 0.0;  ///< Memory of the mover per member; 0: unknown.
  std::vector<Pose> found{};
  std::vector<double> us_each{};  ///< One per round.
};

/// Returns every baseline and both methods of marey one by one; then marey's crowds, in
/// every lane width that this processor supports, and with two threads.
[[nodiscard]] std::vector<CrowdColumn> crowd_columns(
    const std::vector<CrowdMember>& crowd,
    const std::vector<PointGoal>& goals,
    bool with_balance);

}  // namespace marey
