// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Commands that the program prints run in the folder from which it was called.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// Returns the rest of the line of `text` that contains `label`, without the label and
/// the spaces after it; an empty string if there is none.
std::string after_label(const std::string& text, const std::string& label) {
  const std::size_t found = text.find(label);
  if (found == std::string::npos) return "";
  const std::size_t begin = text.find_first_not_of(' ', found + label.size());
  return text.substr(begin, text.find('\n', begin) - begin);
}

/// A shell in an empty folder that calls the program by a relative path.
class NextStep : public ::testing::Test {
 protected:
  [[nodiscard]] ProgramRun shell(const std::string& command) const {
    return run_program(
        "/bin/sh", {"-c", command}, {.folder = folder(), .interrupt_at = ""});
  }
  [[nodiscard]] fs::path folder() const { return folder_.path(); }
  [[nodiscard]] std::string called() const {
    return fs::relative(program(), fs::canonical(folder_.path())).string();
  }

 private:
  ScratchFolder folder_;
};

/// Copies the detections of the sample session, so that its tags are not detected again.
void copy_detections(const fs::path& to) {
  const fs::path from = sample_results() / "once";
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path found = entry.path() / "detections";
    if (!fs::is_directory(found)) continue;
    const fs::path copy = to / entry.path().filename() / "detections";
    fs::create_directories(copy);
    for (const auto& file : fs::directory_iterator(found)) {
      fs::copy(file.path(), copy / file.path().filename());
      fs::last_write_time(copy / file.path().filename(),
                          fs::last_write_time(file.path()));
    }
  }
}

TEST_F(NextStep, ShowsTheResultsAfterTheDemo) {
  copy_detections(folder() / "the results");
  const ProgramRun demo = shell("'" + called() + "' demo --out 'the results'");
  ASSERT_EQ(demo.exit_code, 0) << demo.err;
  EXPECT_EQ(demo.err.find(" view "), std::string::npos) << "printed once: " << demo.err;
  EXPECT_TRUE(after_label(demo.out, "page:").ends_with("/the%20results/report.html"))
      << demo.out;
  const std::string next = after_label(demo.out, "next:");
  ASSERT_NE(next.find(called()), std::string::npos) << demo.out << demo.err;
  const ProgramRun view = shell(next + " --seconds 0.1 --port 0 --no-open");
  EXPECT_EQ(view.exit_code, 0) << next << "\n" << view.err;
  EXPECT_NE(view.out.find("http://"), std::string::npos) << view.out;
}

TEST_F(NextStep, ADemoWithoutItsSampleWritesNothing) {
  const ProgramRun demo = shell("'" + called() + "' demo --sample gone --out results");
  EXPECT_EQ(demo.exit_code, 3);
  EXPECT_NE(demo.err.find("the file does not exist"), std::string::npos) << demo.err;
  EXPECT_FALSE(fs::exists(folder() / "results"));
}

TEST_F(NextStep, NamesTheProgramAsItWasCalledAfterAnError) {
  const ProgramRun run = shell("'" + called() + "' view . --no-open --seconds 1");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("; " + called() + " demo makes results"), std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace marey::testing
