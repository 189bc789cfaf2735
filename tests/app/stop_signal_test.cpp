// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stop_signal.h"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace marey::app {
namespace {

TEST(StopSignal, AsksTheFirstTimeAndEndsTheSecond) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      catch_stop_signals();
      if (stop_wanted()) _exit(1);
      raise(signal);
      if (!stop_wanted()) _exit(2);
      raise(SIGINT);
      _exit(3);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
  }
}

}  // namespace
}  // namespace marey::app
