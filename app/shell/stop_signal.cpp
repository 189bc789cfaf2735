// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/stop_signal.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

#include "app/shell/exit_codes.h"
#include "recordings/base/atomic_file.h"

namespace marey::app {
namespace {

std::atomic<bool> is_wanted = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // Required in signal handlers.

using SignalHandler = void (*)(int);

// Handlers call functions only that are safe in signal handlers.
extern "C" void exit_at_once(int /*signal*/) {
  static constexpr char kText[] = "\ninterrupted\n";
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, static_cast<const char*>(kText), sizeof kText - 1);
  recordings::visit_partial_files([](const char* path) { unlink(path); });
  _exit(static_cast<int>(Exit::kInterrupted));
}

extern "C" void request_stop(int /*signal*/) {
  if (is_wanted.exchange(true)) _exit(static_cast<int>(Exit::kInterrupted));
}

void install(SignalHandler handler) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  // SIGHUP: the terminal was closed. If nohup(1) set it to be ignored, it stays ignored.
  if (std::signal(SIGHUP, handler) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  // A file above the limit of its size is an error of writing, with a message.
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

void exit_on_stop_signals() {
  install(exit_at_once);
}

void catch_stop_signals() {
  is_wanted = false;
  install(request_stop);
  // The reader of the messages may end with the terminal; the recording must still be
  // completed.
  std::signal(SIGPIPE, SIG_IGN);
}

bool stop_wanted() {
  return is_wanted;
}

}  // namespace marey::app
