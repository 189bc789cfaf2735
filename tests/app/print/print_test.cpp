// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Printed pages are reproducible, and invalid options are refused.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/session/session.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// An empty folder, gone with the test.
class Print : public ::testing::Test {
 protected:
  [[nodiscard]] std::string pdf() const { return (folder_ / "out.pdf").string(); }
  [[nodiscard]] fs::path in_folder(const std::string& name) const {
    return folder_ / name;
  }

  /// `marey ARGUMENTS --out out.pdf`.
  [[nodiscard]] ProgramRun print(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--out", pdf()});
    return run_program(marey::testing::program(), arguments);
  }

  void expect_refusal(const std::vector<std::string>& arguments,
                      int exit_code,
                      const std::string& cause,
                      const std::string& next) {
    const ProgramRun run = print(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_NE(run.err.find(cause), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("Next: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(next), std::string::npos) << run.err;
    EXPECT_TRUE(fs::is_empty(folder_.path()));
  }

 private:
  ScratchFolder folder_;
};

TEST_F(Print, GivesTheSameBytesAgain) {
  EXPECT_EQ(print({"tags", "--ids", "41:hips,73:head,1-2", "--size", "40mm", "--plates"})
                .exit_code,
            0);
  const auto once = recordings::read_file(pdf());
  EXPECT_EQ(print({"tags", "--ids", "41:hips,73:head,1-2", "--size", "40mm", "--plates"})
                .exit_code,
            0);
  const auto again = recordings::read_file(pdf());
  ASSERT_TRUE(once && again);
  EXPECT_TRUE(*once == *again);
}

TEST_F(Print, RefusesWordsThatItCannotRead) {
  expect_refusal({"tags", "--ids", "1", "--size", "80"}, 2, "no unit", "80mm");
  expect_refusal({"tags", "--ids", "5-3", "--size", "8cm"}, 2, "goes down", "3-5");
  expect_refusal({"tags", "--ids", "4:hip", "--size", "8cm"}, 2, "segment", "hips");
  expect_refusal(
      {"tags", "--ids", "4", "--size", "8cm", "--page", "B9"}, 2, "page size", "A4");
  expect_refusal({"tags", "--size", "8cm"}, 2, "nothing to print", "--session");
  expect_refusal({"board", "--type", "charuco", "--rows", "5"}, 2, "--rows", "leave it");
}

TEST_F(Print, RefusesTagsThatThereAreNot) {
  expect_refusal({"tags", "--ids", "1", "--size", "8cm", "--family", "tag36h12"},
                 3,
                 "tag36h12",
                 "tag36h11");
  expect_refusal({"tags", "--ids", "580-590", "--size", "8cm"},
                 3,
                 "tag36h11 ends at id 586",
                 "0 to 586");
  expect_refusal(
      {"tags", "--session", marey::testing::sample_session().string(), "--ids", "500"},
      3,
      "500",
      "--ids");
  expect_refusal({"board", "--family", "tag16h5"}, 3, "ends at id 29", "0 to 29");
  expect_refusal({"board", "--type", "charuco", "--dictionary", "DICT_9X9"},
                 3,
                 "DICT_9X9",
                 "DICT_5X5_100");
}

TEST_F(Print, RefusesWhatDoesNotFit) {
  expect_refusal(
      {"tags", "--ids", "1", "--size", "200mm"}, 3, "A4 has room", "--page A3");
  expect_refusal({"tags", "--ids", "1", "--size", "2mm"}, 3, "5 mm", "unit");
  expect_refusal({"board", "--tag-size", "30mm", "--gap", "9mm", "--one-page"},
                 3,
                 "A4 has room",
                 "--page A3");
  expect_refusal({"board", "--gap", "1mm"}, 3, "too little", "2.75 mm");
}

TEST_F(Print, LeavesNothingWhereItCannotWrite) {
  std::ofstream(in_folder("file")) << "in the way";
  const ProgramRun run = run_program(
      marey::testing::program(),
      {"tags", "--ids", "1", "--size", "8cm", "--out", in_folder("file/a.pdf").string()});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("Next: "), std::string::npos) << run.err;
}

// The table that comes with a board, in a session of two cameras.
TEST_F(Print, TablesOfEveryTypeAndFamilyAreReadBySessions) {
  std::vector<std::vector<std::string>> boards{
      {"--type", "charuco"},
      {"--type", "charuco", "--squares-y", "6", "--legacy", "--thickness", "3mm"},
      {"--type", "charuco", "--dictionary", "DICT_APRILTAG_16h5"},
      {"--type", "chessboard"},
      {"--type", "chessboard", "--squares-x", "8", "--square-size", "20mm"}};
  for (const char* family : {"tag16h5",
                             "tag25h9",
                             "tag36h10",
                             "tag36h11",
                             "tag36h11b2",
                             "tagCircle21h7",
                             "tagCircle49h12",
                             "tagCustom48h12",
                             "tagStandard41h12",
                             "tagStandard52h13"}) {
    boards.push_back({"--family", family, "--rows", "3", "--gap", "40mm"});
  }
  for (const std::vector<std::string>& board : boards) {
    std::vector<std::string> words{"board", "--json"};
    words.insert(words.end(), board.begin(), board.end());
    const ProgramRun run = print(words);
    ASSERT_EQ(run.exit_code, 0) << board[1] << run.err;
    const auto said = nlohmann::json::parse(run.out);
    const std::string table = said["board_toml"];
    ASSERT_TRUE(
        recordings::write_file(in_folder("session.toml"),
                               "format = 1\nname = \"boards\"\n" + table +
                                   "[[camera]]\nname = \"a\"\n[[camera]]\nname = \"b\"\n"
                                   "[[trial]]\nname = \"c\"\nkind = \"calibration\"\n"
                                   "videos = { a = \"a\", b = \"b\" }\n"));
    const auto session = recordings::read_session(in_folder("session.toml"));
    ASSERT_TRUE(session) << session.error().message() << table;
    if (const auto* grid = std::get_if<AprilGrid>(&session->target)) {
      EXPECT_EQ(session->family_of(TagId{grid->first_id}), board[1]);
    } else {
      EXPECT_EQ(said["board"]["type"], board[1]);
    }
  }
}

}  // namespace
}  // namespace marey::testing
