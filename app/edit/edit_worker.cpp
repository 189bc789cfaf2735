// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_worker.h"

#include <algorithm>
#include <climits>
#include <cstddef>
#include <string>
#include <utility>

#include "app/edit/edit_jump.h"

namespace marey::app {
namespace {

const EditAsker& asker_of(const EditTask& task) {
  return std::visit([](const auto& one) -> const EditAsker& { return one.asker; }, task);
}

std::optional<std::size_t> operations(std::optional<int> until) {
  if (!until) return std::nullopt;
  return static_cast<std::size_t>(*until);
}

/// Returns whether the files of one recipe are those of another, avatars aside.
bool same_sources(const std::vector<EditSource>& a, const std::vector<EditSource>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return x.id == y.id && x.path == y.path;
      });
}

bool has_avatars(const EditRecipe& recipe, const EditFiles& files) {
  return std::all_of(recipe.ops.begin(), recipe.ops.end(), [&](const EditOp& op) {
    const auto* retarget = std::get_if<RetargetOp>(&op.parameters);
    return retarget == nullptr || op.off || files.avatars.contains(retarget->avatar);
  });
}

}  // namespace

EditWorker::EditWorker(EditFiles files,
                       const EditRecipe& files_of,
                       ReadEditOptions read,
                       EditOutput output,
                       EditListener& listener)
    : files_(std::move(files)),
      sources_(files_of.sources),
      read_(std::move(read)),
      output_(std::move(output)),
      listener_(listener),
      thread_([this] { run(); }) {}

EditWorker::~EditWorker() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
    newest_.reset();
    tasks_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void EditWorker::render(int revision, const EditRecipe& recipe) {
  {
    const std::lock_guard lock(mutex_);
    newest_ = Render{revision, recipe};
  }
  changed_.notify_all();
}

void EditWorker::add(EditTask task) {
  bool is_full = false;
  {
    const std::lock_guard lock(mutex_);
    if (std::holds_alternative<PreviewTask>(task)) {
      const std::uint64_t page = asker_of(task).page;
      std::erase_if(tasks_, [page](const EditTask& other) {
        return std::holds_alternative<PreviewTask>(other) && asker_of(other).page == page;
      });
    }
    is_full = tasks_.size() >= kMaxTasks;
    if (!is_full) tasks_.push_back(std::move(task));
  }
  changed_.notify_all();
  if (is_full) {
    listener_.on_failed(asker_of(task),
                        bad_input("the edit", "too many requests wait", "try again"));
  }
}

void EditWorker::wait_until_idle() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !is_busy_ && !newest_ && tasks_.empty(); });
}

void EditWorker::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_stopping_ || newest_ || !tasks_.empty(); });
    if (is_stopping_) return;
    is_busy_ = true;
    if (newest_) {
      const Render task = *std::exchange(newest_, std::nullopt);
      lock.unlock();
      do_render(task);
    } else {
      const EditTask task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      std::visit([this](const auto& one) { do_task(one); }, task);
    }
    lock.lock();
    is_busy_ = false;
    changed_.notify_all();
  }
}

bool EditWorker::is_outdated(int revision) {
  const std::lock_guard lock(mutex_);
  return is_stopping_ || (newest_ && newest_->revision > revision);
}

/// Reads the files again if the recipe names others.
Status EditWorker::read_files(const EditRecipe& recipe) {
  if (same_sources(recipe.sources, sources_) && has_avatars(recipe, files_)) {
    return Done{};
  }
  auto files = read_edit_files(recipe, read_);
  if (!files) return files.error();
  files_ = *std::move(files);
  sources_ = recipe.sources;
  return Done{};
}

void EditWorker::do_render(const Render& task) {
  EditProgress progress;
  progress.revision = task.revision;
  progress.total = static_cast<int>(task.recipe.ops.size());
  listener_.on_progress(progress);
  const auto fail = [&](const Error& error, std::optional<int> op) {
    progress.state = EditProgress::State::kFailed;
    progress.failed_op = op;
    progress.error = error.message();
    listener_.on_progress(progress);
  };
  if (const Status ok = read_files(task.recipe); !ok) return fail(ok.error(), {});
  const std::vector<std::string> keys = edit_keys(task.recipe, files_);
  edit::RenderOptions options;
  options.keys = keys;
  options.cache = &cache_;
  options.recipe_file = read_.recipe_file;
  options.is_cancelled = [&] { return is_outdated(task.revision); };
  const auto report = [&](int done, int total) {
    progress.done = done;
    if (done < total) listener_.on_progress(progress);
  };
  const auto result = edit::render(task.recipe, files_.inputs, options, report);
  if (is_outdated(task.revision)) return;
  if (!result) return fail(result.error(), progress.done);
  EditResult out{task.revision, task.recipe, files_, *result, {}, {}};
  out.figures = measure_edit(task.recipe, files_, *result);
  out.findings = assess_edit(task.recipe, out.figures);
  progress.done = progress.total;
  progress.state = EditProgress::State::kDone;
  listener_.on_rendered(out);
  listener_.on_progress(progress);
}

Result<edit::Rendered> EditWorker::rendered(const EditRecipe& recipe,
                                            std::optional<int> until) {
  if (const Status ok = read_files(recipe); !ok) return ok.error();
  const std::vector<std::string> keys = edit_keys(recipe, files_);
  edit::RenderOptions options;
  options.until = operations(until);
  options.keys = keys;
  options.cache = &cache_;
  options.recipe_file = read_.recipe_file;
  // Only the end of the worker stops it.
  options.is_cancelled = [this] { return is_outdated(INT_MAX); };
  return edit::render(recipe, files_.inputs, options);
}

void EditWorker::do_task(const PreviewTask& task) {
  const auto result = rendered(task.recipe, task.parts.until);
  if (!result) return listener_.on_failed(task.asker, result.error());
  listener_.on_preview(
      task.asker, task.parts, {task.revision, task.recipe, files_, *result, {}, {}});
}

void EditWorker::do_task(const LoopsTask& task) {
  const auto result = rendered(task.recipe, task.until);
  if (!result) return listener_.on_failed(task.asker, result.error());
  if (task.output >= static_cast<int>(result->outputs.size())) {
    return listener_.on_failed(
        task.asker, bad_input("the edit", "it has no such result", "choose another"));
  }
  const edit::EditState& state = result->outputs[static_cast<std::size_t>(task.output)];
  if (const Status ok = edit::check_loop_search(state, task.options); !ok) {
    return listener_.on_failed(task.asker, ok.error());
  }
  EditLoops out;
  out.revision = task.revision;
  out.until = task.until;
  out.output = task.output;
  out.rate_hz = state.motion.rate.hz;
  out.candidates = edit::find_loops(state, task.options);
  if (task.map) out.map = edit::loop_map(state);
  listener_.on_loops(task.asker, out);
}

void EditWorker::do_task(const JumpTask& task) {
  const auto result = rendered(task.recipe, task.op);
  if (!result) return listener_.on_failed(task.asker, result.error());
  if (task.output >= static_cast<int>(result->outputs.size())) {
    return listener_.on_failed(
        task.asker, bad_input("the edit", "it has no such result", "choose another"));
  }
  auto graph = jump_graph_of(task.recipe,
                             task.op,
                             files_.inputs,
                             result->outputs[static_cast<std::size_t>(task.output)]);
  if (!graph) return listener_.on_failed(task.asker, graph.error());
  const auto& op = task.recipe.ops[static_cast<std::size_t>(task.op)];
  listener_.on_jump(task.asker,
                    {task.revision,
                     task.op,
                     task.output,
                     std::get<JumpOp>(op.parameters).jump,
                     *std::move(graph)});
}

void EditWorker::do_task(const ExportTask& task) {
  const auto result = rendered(task.recipe, std::nullopt);
  if (!result) return listener_.on_failed(task.asker, result.error());
  const auto figures = measure_edit(task.recipe, files_, *result);
  const auto files = write_edit(task.recipe, files_, *result, figures, output_);
  if (!files) return listener_.on_failed(task.asker, files.error());
  listener_.on_exported(task.asker,
                        {task.revision, *files, assess_edit(task.recipe, figures)});
}

}  // namespace marey::app
