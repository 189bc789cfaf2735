// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/session_source.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "app/library/build/process_pool.h"
#include "app/library/sources/read_source.h"
#include "recordings/motion/npz.h"
#include "tests/app/library/sources/source_scene.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

std::map<fs::path, fs::file_time_type> times_below(const fs::path& folder) {
  std::map<fs::path, fs::file_time_type> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    out.emplace(entry.path(), entry.last_write_time());
  }
  return out;
}

/// Returns the archive of a session's only motion, or why there is none.
std::string solved_bytes(const fs::path& scratch) {
  ReadSourceOptions options;
  options.scratch = scratch;
  const auto all = read_source(
      marey::testing::source_at(marey::testing::sample_session()), {}, options);
  if (!all) return all.error().message();
  if (all->size() != 1 || all->front().body != "walk") return "other motions";
  for (const char* name : {"residual_px", "solved_share"}) {
    const bool is_known =
        std::ranges::find(all->front().figures, name, &ClipFigure::name) !=
        all->front().figures.end();
    if (!is_known || all->front().subject.empty()) return name;
  }
  recordings::NpzExtras extras;
  extras.uncertainty = all->front().uncertainty;
  auto bytes = recordings::npz_bytes(all->front().motion, extras);
  return bytes ? *std::move(bytes) : bytes.error().message();
}

// In a child process, as builds do.
TEST(SessionSource, SolvesASessionAsTheProgramDoes) {
  const marey::testing::ScratchFolder scratch;
  const auto before = times_below(marey::testing::sample_session());
  const auto outcomes = run_in_processes(
      1,
      1,
      [&](std::size_t) { return solved_bytes(scratch.path()); },
      [](std::size_t) { return true; });
  ASSERT_TRUE(outcomes[0].is_done) << outcomes[0].signal.value_or(0);
  EXPECT_EQ(times_below(marey::testing::sample_session()), before);
  EXPECT_TRUE(fs::is_empty(scratch.path())) << "temporary results are removed";
  const auto read = recordings::parse_npz(outcomes[0].text, "walk");
  ASSERT_TRUE(read) << outcomes[0].text.substr(0, 1000);
  const auto program = recordings::read_npz(marey::testing::sample_results() / "once" /
                                            "walk" / "motion.npz");
  ASSERT_TRUE(program) << program.error().message();
  ASSERT_EQ(read->motion.poses.size(), program->motion.poses.size());
  for (std::size_t f = 0; f < read->motion.poses.size(); ++f) {
    EXPECT_EQ(read->motion.poses[f].root_in_world,
              program->motion.poses[f].root_in_world);
    EXPECT_EQ(read->motion.poses[f].parent_from_joint,
              program->motion.poses[f].parent_from_joint);
  }
}

}  // namespace
}  // namespace marey::app
