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

/// What all contenders are asked.
struct Contest {
  std::string id;
  std::string title;
  const Character* character = nullptr;  ///< Skeleton and masses by which it is judged.
  std::vector<PointGoal> goals;
  std::vector<PostureTask> tasks;
};

/// How long and how near: one row for each contender.
///
/// Solvers take turns, five rounds, so that a processor that changes its pace changes it
/// for all. Of each task the fastest of five runs counts ("us", "p95 us": median and 95 %
/// of the tasks); "in a row us" is all tasks once, one after the other, by their number,
/// in time of the processor. Of the rounds always the median. Precondition: there are
/// tasks.
[[nodiscard]] ResultTable compare_solvers(const Contest& contest,
                                          std::vector<Contender> contenders);

/// Every solver there is, made for this problem.
[[nodiscard]] std::vector<Contender> all_contenders(const PostureProblem& problem);

}  // namespace marey
