// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/process_pool.h"

#include <csignal>
#include <cstdlib>
#include <new>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace marey::app {
namespace {

const auto kGoOn = [](std::size_t) { return true; };

TEST(ProcessPool, ReturnsTheTextsOfAllTasksInOrder) {
  for (const int processes : {1, 2, 7}) {
    const auto outcomes = run_in_processes(
        40,
        processes,
        [](std::size_t i) {
          return std::string(i * 5000, static_cast<char>('a' + i % 26));
        },
        kGoOn);
    ASSERT_EQ(outcomes.size(), 40u);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      EXPECT_TRUE(outcomes[i].is_done);
      EXPECT_EQ(outcomes[i].text, std::string(i * 5000, static_cast<char>('a' + i % 26)));
    }
  }
}

TEST(ProcessPool, UsesOtherProcesses) {
  const auto outcomes = run_in_processes(
      8, 2, [](std::size_t) { return std::to_string(getpid()); }, kGoOn);
  std::set<std::string> pids;
  for (const TaskOutcome& outcome : outcomes) pids.insert(outcome.text);
  EXPECT_FALSE(pids.contains(std::to_string(getpid())));
  EXPECT_LE(pids.size(), 2u);
}

TEST(ProcessPool, LosesOnlyTheTaskThatCrashes) {
  for (const int processes : {1, 3}) {
    const auto outcomes = run_in_processes(
        20,
        processes,
        [](std::size_t i) -> std::string {
          if (i % 7 == 3) std::raise(SIGKILL);
          if (i == 5) _exit(9);
          return std::to_string(i);
        },
        kGoOn);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const bool crashes = i % 7 == 3 || i == 5;
      EXPECT_EQ(outcomes[i].is_done, !crashes) << i;
      if (!crashes) {
        EXPECT_EQ(outcomes[i].text, std::to_string(i));
      } else {
        EXPECT_EQ(outcomes[i].signal, i == 5 ? 0 : SIGKILL) << "5 ends by itself";
      }
    }
  }
}

TEST(ProcessPool, BeginsNoTaskAfterAStop) {
  const auto outcomes = run_in_processes(
      30,
      2,
      [](std::size_t i) { return std::to_string(i); },
      [](std::size_t done) { return done < 5; });
  std::size_t done = 0;
  for (const TaskOutcome& outcome : outcomes) done += outcome.is_done ? 1 : 0;
  EXPECT_GE(done, 5u);
  EXPECT_LE(done, 7u);
  EXPECT_TRUE(run_in_processes(0, 2, nullptr, kGoOn).empty());
}

TEST(ProcessPool, EndsAChildThatThrows) {
  const auto outcomes = run_in_processes(
      3,
      1,
      [](std::size_t i) -> std::string {
        if (i == 1) throw std::bad_alloc();
        return "done";
      },
      kGoOn);
  EXPECT_TRUE(outcomes[0].is_done);
  EXPECT_FALSE(outcomes[1].is_done);
  EXPECT_EQ(outcomes[1].signal, SIGABRT);
  EXPECT_TRUE(outcomes[2].is_done);
}

}  // namespace
}  // namespace marey::app
