// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/stop_signal.h"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace marey::app {
namespace {

TEST(StopSignal, AsksTheFirstTimeAndEndsTheSecond) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
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

// nohup(1) starts programs so.
TEST(StopSignal, LeavesAnIgnoredHangUpIgnored) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    (void)std::signal(SIGHUP, SIG_IGN);
    catch_stop_signals();
    raise(SIGHUP);
    raise(SIGPIPE);
    _exit(stop_wanted() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace marey::app
