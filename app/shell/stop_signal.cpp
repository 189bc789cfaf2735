// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/stop_signal.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

namespace marey::app {
namespace {

constexpr int kInterrupted = 130;

std::atomic<bool> is_wanted = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // Required in signal handlers.

extern "C" void on_stop(int /*signal*/) {
  if (is_wanted.exchange(true)) _exit(kInterrupted);
}

}  // namespace

void catch_stop_signals() {
  is_wanted = false;
  std::signal(SIGINT, on_stop);
  std::signal(SIGTERM, on_stop);
  // SIGHUP: the terminal was closed. If nohup(1) set it to be ignored, it stays ignored.
  if (std::signal(SIGHUP, on_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  // The reader of the messages may end with the terminal; the recording must still be
  // completed.
  std::signal(SIGPIPE, SIG_IGN);
}

bool stop_wanted() {
  return is_wanted;
}

}  // namespace marey::app
