// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// No command takes a number that is none.
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"

namespace marey::testing {
namespace {

ProgramRun marey(const std::vector<std::string>& arguments) {
  return run_program(marey::testing::program(), arguments);
}

/// The commands that `words --help` lists.
std::vector<std::string> commands_of(std::vector<std::string> words) {
  words.emplace_back("--help");
  std::istringstream help(marey(words).out);
  std::vector<std::string> out;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (line.find("ubcommands:") != std::string::npos) {
      listed = true;
    } else if (listed && line.size() > 2 && line[0] == ' ' && line[2] != ' ') {
      std::istringstream name(line);
      name >> out.emplace_back();
    }
  }
  return out;
}

/// The options of a command that take a floating-point number, by their long names.
std::vector<std::string> float_options_of(std::vector<std::string> words) {
  words.emplace_back("--help");
  std::istringstream help(marey(words).out);
  std::vector<std::string> out;
  for (std::string line; std::getline(help, line);) {
    const std::size_t type = line.find(" FLOAT");
    const std::size_t name = line.find("--");
    if (type == std::string::npos || name == std::string::npos || type < name) continue;
    out.push_back(line.substr(name, line.find_first_of(" ,", name) - name));
  }
  return out;
}

/// Tries the options of a command and of the commands below it; returns how many.
int try_options(const std::vector<std::string>& words) {
  int tried = 0;
  for (const std::string& option : float_options_of(words)) {
    for (const char* word : {"nan", "-nan", "inf", "-inf", "1e999", "1e30"}) {
      std::vector<std::string> arguments = words;
      arguments.push_back(option + "=" + word);
      const ProgramRun run = marey(arguments);
      EXPECT_EQ(run.exit_code, 2) << words.front() << " " << option << " " << word;
      EXPECT_NE(run.err.find(option), std::string::npos)
          << words.front() << " " << option << " " << word << ": " << run.err;
    }
    ++tried;
  }
  for (const std::string& command : commands_of(words)) {
    std::vector<std::string> below = words;
    below.push_back(command);
    tried += try_options(below);
  }
  return tried;
}

TEST(OptionValues, ThatAreNoNumberOrNotFiniteOrAbsurdAreRefusedByEveryCommand) {
  int tried = 0;
  for (const std::string& command : commands_of({})) tried += try_options({command});
  EXPECT_GT(tried, 25);
}

TEST(OptionValues, NamedByTheIssueAreRefused) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"plan", "--height", "nan"},
           {"repair", "--max-sigma", "nan"},
           {"repair", "--most-sigma", "nan"},  // Former.
           {"adapt", "--root-share", "nan"}}) {
    const ProgramRun run = marey(words);
    EXPECT_EQ(run.exit_code, 2) << words.front();
    EXPECT_NE(run.err.find("must be a number"), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace marey::testing
