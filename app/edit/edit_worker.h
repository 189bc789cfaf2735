// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "edit/find/find_loops.h"
#include "edit/render.h"

#include "app/edit/edit_events.h"
#include "app/edit/edit_inputs.h"
#include "app/edit/edit_outputs.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// Renders a recipe of one page's request.
struct PreviewTask {
  EditAsker asker;
  int revision = 0;
  EditRecipe recipe;
  PreviewParts parts;
};
struct LoopsTask {
  EditAsker asker;
  int revision = 0;
  EditRecipe recipe;
  std::optional<int> until;
  int output = 0;
  edit::FindLoopsOptions options;
  bool map = false;
};
struct JumpTask {
  EditAsker asker;
  int revision = 0;
  EditRecipe recipe;
  int op = 0;      ///< Index of an operation `jump` of the recipe.
  int output = 0;  ///< Index of the motion that it receives.
};
struct ExportTask {
  EditAsker asker;
  int revision = 0;
  EditRecipe recipe;
};
using EditTask = std::variant<PreviewTask, LoopsTask, JumpTask, ExportTask>;

/// Renders recipes on a thread of its own. The newest revision comes before the requests
/// of pages, which come in their order. Files are read again if a recipe names others.
/// Results of operations are kept, so that a change costs the operations after it.
class EditWorker {
 public:
  /// Starts the thread. `files` are those of the first recipe. `listener` must outlive
  /// the worker.
  EditWorker(EditFiles files,
             const EditRecipe& files_of,
             ReadEditOptions read,
             EditOutput output,
             EditListener& listener);
  EditWorker(const EditWorker&) = delete;
  EditWorker& operator=(const EditWorker&) = delete;
  /// Stops after the running operation; waiting tasks are dropped.
  ~EditWorker();

  /// Renders a revision and drops waiting ones; a running one stops between
  /// two operations.
  void render(int revision, const EditRecipe& recipe);
  /// Adds a task. A preview replaces a waiting one of the same page. Other pages' tasks
  /// and exports are kept; at most kMaxTasks wait, and further ones fail.
  void add(EditTask task);
  /// Waits until nothing waits or runs. For tests, and before the end of a program.
  void wait_until_idle();

  static constexpr std::size_t kMaxTasks = 64;

 private:
  struct Render {
    int revision = 0;
    EditRecipe recipe;
  };

  void run();
  void do_render(const Render& task);
  void do_task(const PreviewTask& task);
  void do_task(const LoopsTask& task);
  void do_task(const JumpTask& task);
  void do_task(const ExportTask& task);
  [[nodiscard]] Status read_files(const EditRecipe& recipe);
  [[nodiscard]] Result<edit::Rendered> rendered(const EditRecipe& recipe,
                                                std::optional<int> until);
  [[nodiscard]] bool is_outdated(int revision);

  // The worker's own.
  EditFiles files_;
  std::vector<EditSource> sources_;  ///< Key of the recipe that files_ belong to.
  const ReadEditOptions read_;
  const EditOutput output_;
  EditListener& listener_;
  edit::EditCache cache_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Render> newest_;
  std::deque<EditTask> tasks_;
  bool is_busy_ = false;
  bool is_stopping_ = false;
  std::thread thread_;  ///< Last, because it uses the others.
};

}  // namespace marey::app
