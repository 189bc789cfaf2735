// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/program_name.h"

#include <string>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

TEST(ProgramName, WritesThePathOfTheCallIntoCommands) {
  const ProgramName name("build/app/marey", {"view", "process"});
  EXPECT_EQ(name.written_into("marey view out"), "build/app/marey view out");
  EXPECT_EQ(name.written_into("run: marey process S; marey view DIR"),
            "run: build/app/marey process S; build/app/marey view DIR");
  EXPECT_EQ(name.written_into("see (marey view, `marey process`)"),
            "see (build/app/marey view, `build/app/marey process`)");
  const ProgramName with_help("./marey", {"view", "--help"});
  EXPECT_EQ(with_help.written_into("marey --help lists them"),
            "./marey --help lists them");
}

TEST(ProgramName, LeavesOtherWordsAsTheyAre) {
  const ProgramName name("./marey", {"view"});
  for (const char* text : {"",
                           "marey",
                           "marey ",
                           "a file that marey wrote",
                           "marey viewed it",
                           "old/marey view",
                           "marey-view",
                           "marey  view"}) {
    EXPECT_EQ(name.written_into(text), text);
  }
}

TEST(ProgramName, IsMareyIfTheCallHasNoName) {
  EXPECT_EQ(ProgramName("", {"view"}).written_into("marey view"), "marey view");
  EXPECT_EQ(ProgramName().written_into("marey view"), "marey view");
}

TEST(ProgramName, IsQuotedForAShell) {
  const ProgramName name("my programs/marey", {"view"});
  EXPECT_EQ(name.written_into("marey view"), "'my programs/marey' view");
}

TEST(ShellCommand, QuotesWordsThatAShellWouldChange) {
  EXPECT_EQ(shell_command({"marey", "view", "out/first-light"}),
            "marey view out/first-light");
  EXPECT_EQ(shell_command({"marey", "a b", "", "$x", "it's"}),
            "marey 'a b' '' '$x' 'it'\\''s'");
}

}  // namespace
}  // namespace marey::app
