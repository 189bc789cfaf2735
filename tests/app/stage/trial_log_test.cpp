// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/trial_log.h"

#include <csignal>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recordings/base/temporary_folder.h"

namespace marey::app {
namespace {

TrialRow trial_of(int number, bool has_keeper) {
  std::mt19937_64 random(static_cast<std::uint64_t>(number));
  std::normal_distribution<double> normal(0.0, 3.0);
  TrialRow row;
  row.number = number;
  row.parameter = "speed_m_s";
  row.value = normal(random);
  row.repetition = 1 + number % 3;
  row.start_s = normal(random);
  row.asked.place_m = {normal(random), normal(random), normal(random)};
  row.asked.azimuth_deg = normal(random);
  row.measured.release_s = normal(random);
  row.release_s = normal(random);
  if (number % 2 == 0) row.arrival = TrialArrival{normal(random), {1.0, 2.0, 0.1}};
  if (has_keeper) {
    row.keeper = KeeperResponse{number % 2, normal(random), std::nullopt, {0.1, 1.0, -2}};
  }
  return row;
}

std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(TrialLog, LinesReadBackAsTheSameNumbers) {
  for (int number = 1; number <= 200; ++number) {
    const std::string line = trial_line(trial_of(number, number % 3 == 0));
    const std::optional<TrialRow> read = read_trial_line(line);
    ASSERT_TRUE(read) << line;
    EXPECT_EQ(trial_line(*read), line);
    EXPECT_EQ(read->asked.azimuth_deg, trial_of(number, false).asked.azimuth_deg);
  }
}

TEST(TrialLog, EveryLineHasACellForEachColumn) {
  const auto commas = [](const std::string& text) {
    return std::count(text.begin(), text.end(), ',');
  };
  for (int number = 1; number <= 4; ++number) {
    EXPECT_EQ(commas(trial_line(trial_of(number, number > 2))), commas(trial_header()));
  }
}

TEST(TrialLog, DamagedLinesAreRefused) {
  const std::string line = trial_line(trial_of(2, true));
  EXPECT_TRUE(read_trial_line(line));
  EXPECT_FALSE(read_trial_line(line + ","));
  EXPECT_FALSE(read_trial_line(line.substr(0, line.size() / 2)));
  EXPECT_FALSE(read_trial_line("x" + line));
  EXPECT_FALSE(read_trial_line(""));
}

TEST(TrialLog, IsCompleteAfterTheProcessWasKilled) {
  const recordings::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "trials.csv";
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    Result<TrialLog> log = TrialLog::open(path);
    for (int number = 1; log && number <= 25; ++number) {
      if (!log->add(trial_of(number, false))) _exit(1);
    }
    if (write(ready[1], "x", 1) != 1) _exit(1);
    pause();
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  Result<TrialLog> log = TrialLog::open(path);
  ASSERT_TRUE(log) << log.error().message();
  ASSERT_EQ(log->earlier_rows().size(), 25U);
  EXPECT_EQ(trial_line(log->earlier_rows().back()), trial_line(trial_of(25, false)));
}

TEST(TrialLog, ContinuesAfterARowThatIsIncomplete) {
  const recordings::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "trials.csv";
  std::ofstream(path) << trial_header() << '\n'
                      << trial_line(trial_of(1, false)) << "\n2,speed_m";
  {
    Result<TrialLog> log = TrialLog::open(path);
    ASSERT_TRUE(log) << log.error().message();
    EXPECT_EQ(log->earlier_rows().size(), 1U);
    EXPECT_TRUE(log->add(trial_of(2, true)));
    EXPECT_TRUE(log->sync_if_due());
  }
  EXPECT_EQ(text_of_file(path),
            trial_header() + "\n" + trial_line(trial_of(1, false)) + "\n" +
                trial_line(trial_of(2, true)) + "\n");
}

TEST(TrialLog, RefusesAnotherTableAndADamagedRow) {
  const recordings::TemporaryFolder folder;
  const std::filesystem::path other = folder.path() / "other.csv";
  std::ofstream(other) << "a,b\n1,2\n";
  EXPECT_FALSE(TrialLog::open(other));
  const std::filesystem::path damaged = folder.path() / "damaged.csv";
  std::ofstream(damaged) << trial_header() << "\n1,speed_m_s,x\n";
  const Result<TrialLog> log = TrialLog::open(damaged);
  ASSERT_FALSE(log);
  EXPECT_NE(log.error().message().find("line 2"), std::string::npos);
}

}  // namespace
}  // namespace marey::app
