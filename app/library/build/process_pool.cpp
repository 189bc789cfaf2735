// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/process_pool.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace marey::app {
namespace {

/// Reads exactly `size` bytes. Returns false at the end of the stream.
bool read_all(int descriptor, void* into, std::size_t size) {
  auto* at = static_cast<char*>(into);
  while (size > 0) {
    const ssize_t got = read(descriptor, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_all(int descriptor, const void* from, std::size_t size) {
  const auto* at = static_cast<const char*>(from);
  while (size > 0) {
    const ssize_t put = write(descriptor, at, size);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    at += put;
    size -= static_cast<std::size_t>(put);
  }
  return true;
}

/// While it exists, a write to a child that has ended fails, instead of ending this
/// process.
class IgnoredBrokenPipes {
 public:
  IgnoredBrokenPipes() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~IgnoredBrokenPipes() { std::signal(SIGPIPE, before_); }
  IgnoredBrokenPipes(const IgnoredBrokenPipes&) = delete;
  IgnoredBrokenPipes& operator=(const IgnoredBrokenPipes&) = delete;

 private:
  void (*before_)(int);
};

/// A child process, as its parent sees it.
struct Child {
  pid_t pid = -1;
  int tasks = -1;    ///< Numbers of tasks are written here.
  int results = -1;  ///< Results are read here.
  std::size_t task = 0;
  bool is_busy = false;
};

/// The loop of a child: a number in, a size and a text out. An exception, such as
/// std::bad_alloc, ends the child by a signal: it must not reach the parent's code.
[[noreturn]] void serve_tasks(
    int tasks,
    int results,
    const std::function<std::string(std::size_t)>& task) noexcept {
  std::uint64_t number = 0;
  while (read_all(tasks, &number, sizeof(number))) {
    const std::string text = task(static_cast<std::size_t>(number));
    const std::uint64_t size = text.size();
    if (!write_all(results, &size, sizeof(size)) ||
        !write_all(results, text.data(), text.size())) {
      break;
    }
  }
  // Without destructors of objects that belong to the parent.
  _exit(0);
}

class ProcessPool {
 public:
  ProcessPool(std::size_t count,
              const std::function<std::string(std::size_t)>& task,
              const std::function<bool(std::size_t)>& finished)
      : task_(task), finished_(finished), outcomes_(count) {}

  std::vector<TaskOutcome> run(int processes) {
    const IgnoredBrokenPipes ignored;
    const auto wanted =
        std::min<std::size_t>(static_cast<std::size_t>(processes), outcomes_.size());
    for (std::size_t i = 0; i < wanted; ++i) begin_child();
    while (wait_for_one()) {
    }
    while (!children_.empty()) end_child(children_.size() - 1);
    return std::move(outcomes_);
  }

 private:
  /// Begins a child and gives it a task, if there are any.
  void begin_child() {
    if (!may_begin()) return;
    std::array<int, 2> tasks{};
    std::array<int, 2> results{};
    if (pipe(tasks.data()) != 0) return;
    if (pipe(results.data()) != 0) {
      close(tasks[0]);
      close(tasks[1]);
      return;
    }
    std::fflush(nullptr);  // Otherwise the child would write buffered text again.
    const pid_t pid = fork();
    if (pid == 0) {
      close(tasks[1]);
      close(results[0]);
      // An open end of another child's pipe would hide that its parent has ended.
      for (const Child& other : children_) {
        close(other.tasks);
        close(other.results);
      }
      serve_tasks(tasks[0], results[1], task_);
    }
    close(tasks[0]);
    close(results[1]);
    if (pid < 0) {
      close(tasks[1]);
      close(results[0]);
      return;
    }
    children_.push_back({pid, tasks[1], results[0], 0, false});
    give_task(children_.back());
  }

  [[nodiscard]] bool may_begin() const {
    return !is_stopped_ && next_ < outcomes_.size();
  }

  void give_task(Child& child) {
    child.is_busy = false;
    if (!may_begin()) return;
    child.task = next_++;
    child.is_busy = true;
    const std::uint64_t number = child.task;
    // If the child has ended, its results end, too: collect() sees it.
    write_all(child.tasks, &number, sizeof(number));
  }

  /// Waits for the result of a child. Returns false if none is busy.
  bool wait_for_one() {
    std::vector<pollfd> waiting;
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < children_.size(); ++i) {
      if (!children_[i].is_busy) continue;
      waiting.push_back({children_[i].results, POLLIN, 0});
      which.push_back(i);
    }
    if (waiting.empty()) return false;
    if (poll(waiting.data(), waiting.size(), -1) < 0) return errno == EINTR;
    // From the last one, as children that have ended are removed.
    for (std::size_t k = waiting.size(); k-- > 0;) {
      if (waiting[k].revents != 0) collect(which[k]);
    }
    return true;
  }

  void collect(std::size_t place) {
    Child& child = children_[place];
    TaskOutcome& outcome = outcomes_[child.task];
    std::uint64_t size = 0;
    outcome.is_done = read_all(child.results, &size, sizeof(size));
    if (outcome.is_done) {
      outcome.text.resize(static_cast<std::size_t>(size));
      outcome.is_done = read_all(child.results, outcome.text.data(), outcome.text.size());
    }
    const bool has_ended = !outcome.is_done;
    if (has_ended) {
      outcome.text.clear();
      outcome.signal = end_child(place);
    }
    ++done_;
    if (!finished_(done_)) is_stopped_ = true;
    if (has_ended) {
      begin_child();
    } else {
      give_task(children_[place]);
    }
  }

  /// Returns the signal that ended the child; 0: none.
  int end_child(std::size_t place) {
    const Child child = children_[place];
    children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(place));
    close(child.tasks);
    close(child.results);
    int status = 0;
    while (waitpid(child.pid, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

  const std::function<std::string(std::size_t)>& task_;
  const std::function<bool(std::size_t)>& finished_;
  std::vector<TaskOutcome> outcomes_;
  std::vector<Child> children_;
  std::size_t next_ = 0;
  std::size_t done_ = 0;
  bool is_stopped_ = false;
};

}  // namespace

std::vector<TaskOutcome> run_in_processes(
    std::size_t count,
    int processes,
    const std::function<std::string(std::size_t)>& task,
    const std::function<bool(std::size_t)>& finished) {
  return ProcessPool(count, task, finished).run(std::max(processes, 1));
}

}  // namespace marey::app
