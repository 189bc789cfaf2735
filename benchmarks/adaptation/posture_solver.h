// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/adaptation/gauss_newton_baseline.h"
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/pose.h"

namespace marey {

/// One posture and what is wanted of it. Views: the caller keeps what they look at.
struct PostureTask {
  const Pose* reference = nullptr;
  std::span<const glm::dvec3> targets_in_world;  ///< One per goal.
  glm::dvec3 com_in_world{0.0};
};

/// Anything that adapts postures of one body to one list of goals.
class PostureSolver {
 public:
  virtual ~PostureSolver() = default;

  /// What may be done before the clock starts: the reference in the solver's own numbers.
  virtual void load(const PostureTask& task) = 0;
  /// What is timed. Iterations. Precondition: load() of the same task.
  virtual int solve(const PostureTask& task) = 0;
  /// The posture that was found last.
  virtual void store(Pose& out) const = 0;
};

/// What a solver is made for.
struct PostureProblem {
  const Character* character = nullptr;  ///< The caller's.
  std::vector<PointGoal> goals;
  bool with_balance = false;  ///< Horizontally.
};

/// A column of the tables: how to make this kind of solver, and what it is called.
struct SolverKind {
  std::string name;
  std::unique_ptr<PostureSolver> (*make)(const PostureProblem& problem) = nullptr;
};

/// The Gauss-Newton baselines: dual in float and in double, strict in double.
[[nodiscard]] std::vector<SolverKind> baseline_solvers();

/// marey's, in the order in which tables tell them.
[[nodiscard]] std::vector<SolverKind> marey_solvers();

}  // namespace marey
