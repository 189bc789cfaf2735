// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/motion/npz.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {

/// A walk and a recipe for it.
class EditFolder {
 public:
  EditFolder() {
    EXPECT_TRUE(recordings::write_npz(folder_ / "walk.npz",
                                      synthetic_walk(360, 120.0, 0.002, 0.0005).motion));
  }

  void write_recipe(const std::string& operations,
                    const std::string& source = "path = \"walk.npz\"",
                    const std::string& name = "a.edit.toml") const {
    const std::string text =
        "format = 1\nname = \"a\"\n[source]\n" + source + "\n" + operations;
    EXPECT_TRUE(recordings::write_file(folder_ / name, text));
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> more = {},
                               const std::string& recipe = "a.edit.toml") const {
    std::vector<std::string> arguments{
        "--progress", "none", "edit", recipe, "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(
        program(), arguments, {.folder = folder_.path(), .interrupt_at = {}});
  }
  [[nodiscard]] ProgramRun call(const std::vector<std::string>& arguments) const {
    return run_program(
        program(), arguments, {.folder = folder_.path(), .interrupt_at = {}});
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  [[nodiscard]] std::string bytes(const std::string& name) const {
    const auto text = recordings::read_file(folder_ / name);
    return text ? *text : "missing";
  }

 private:
  ScratchFolder folder_;
};

}  // namespace marey::testing
