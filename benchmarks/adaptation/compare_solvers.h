// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/adaptation/posture_solver.h"
#include "benchmarks/parts/result_table.h"
#include "core/character.h"

namespace marey {

/// A row of the table.
struct Contender {
  std::string name;
  std::unique_ptr<PostureSolver> solver;
};

/// The tasks that all contenders solve.
struct Contest {
  std::string id;
  std::string title;
  const Character* character = nullptr;  ///< Skeleton and masses for the measures.
  std::vector<PointGoal> goals;
  std::vector<PostureTask> tasks;
};

/// Measures times and errors of the contenders: one row for each contender.
///
/// The solvers take turns in five rounds, so that a change of the processor's frequency
/// affects all of them. The fastest of five runs counts for each task ("us", "p95 us":
/// median and 95 % quantile over the tasks). "in a row us" is the processor time of one
/// pass over all tasks, divided by their number. Each time is the median over the rounds.
/// Precondition: there are tasks.
[[nodiscard]] ResultTable compare_solvers(const Contest& contest,
                                          std::vector<Contender> contenders);

/// Returns every available solver, made for this problem.
[[nodiscard]] std::vector<Contender> all_contenders(const PostureProblem& problem);

}  // namespace marey
