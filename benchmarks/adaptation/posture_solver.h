// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "benchmarks/baseline/gauss_newton_baseline.h"
#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// One posture and its targets. The members are views: the caller keeps the data.
struct PostureTask {
  const Pose* reference = nullptr;
  std::span<const glm::dvec3> targets_in_world;  ///< One per goal.
  glm::dvec3 com_in_world{0.0};
};

/// A solver that adapts postures of one body to one list of goals.
class PostureSolver {
 public:
  virtual ~PostureSolver() = default;

  /// Prepares a solve outside the measured time: converts the reference to the solver's
  /// number type.
  virtual void load(const PostureTask& task) = 0;
  /// Solves the task, within the measured time. Returns the number of iterations.
  /// Precondition: load() of the same task.
  virtual int solve(const PostureTask& task) = 0;
  /// Writes the result of the last solve().
  virtual void store(Pose& out) const = 0;
};

/// The body and the goals that a solver is made for.
struct PostureProblem {
  const Character* character = nullptr;  ///< Owned by the caller.
  std::vector<PointGoal> goals;
  bool with_balance = false;  ///< Horizontally.
};

/// A kind of solver in the tables: its name and its factory function.
struct SolverKind {
  std::string name;
  std::unique_ptr<PostureSolver> (*make)(const PostureProblem& problem) = nullptr;
};

/// The Gauss-Newton baselines: dual in float and in double, strict in double.
[[nodiscard]] std::vector<SolverKind> baseline_solvers();

/// The solvers of marey, in the order of the tables.
[[nodiscard]] std::vector<SolverKind> marey_solvers();

}  // namespace marey
