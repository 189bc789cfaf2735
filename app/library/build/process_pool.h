// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace marey::app {

/// Result of one task.
struct TaskOutcome {
  bool is_done = false;
  std::string text;           ///< Returned by the task.
  std::optional<int> signal;  ///< That ended its process.
};

/// Runs task(0) to task(count - 1) in child processes, in ascending order, each in one of
/// them. A task that crashes costs only its own outcome: its process is replaced.
/// Outcomes do not depend on the number of processes. `finished` is called in this
/// process after each task, with the number of finished ones; if it returns false, no
/// other task is begun, and outcomes of tasks that were not begun are not done. Children
/// end with this process. Without any child (no memory, too many processes) all other
/// tasks are not done. Precondition: this process has one thread; children are copies of
/// it.
[[nodiscard]] std::vector<TaskOutcome> run_in_processes(
    std::size_t count,
    int processes,
    const std::function<std::string(std::size_t)>& task,
    const std::function<bool(std::size_t)>& finished);

}  // namespace marey::app
