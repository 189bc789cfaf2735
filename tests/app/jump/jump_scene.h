// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/motion.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {

/// A folder for `marey jump` with walk.npz, a walk without a flight, and, if the shared
/// data is there, jump.npz, a captured jump (CMU 02_04): 120 Hz, take-off at 0.91 s,
/// touch-down at 1.46 s.
class JumpScene {
 public:
  JumpScene();

  [[nodiscard]] bool has_jump() const { return has_jump_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  /// Runs `marey jump MOTION --out OUT` and more in the folder.
  [[nodiscard]] ProgramRun jump(const std::string& motion,
                                const std::string& out,
                                const std::vector<std::string>& more) const;
  /// Runs jump() with --json; the test fails unless it succeeds and prints an object.
  [[nodiscard]] nlohmann::json figures(const std::string& motion,
                                       const std::string& out,
                                       std::vector<std::string> more) const;
  /// Returns the motion of an .npz; the test fails when there is none.
  [[nodiscard]] Motion motion(const std::string& name) const;
  /// Writes frames `first` to `last` of jump.npz, every `step`-th, under another name.
  void write_part(const std::string& name, int first, int last, int step = 1) const;
  /// Returns the names of all files in the folder, sorted.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  ScratchFolder folder_;
  bool has_jump_ = false;
};

/// Height of the centre of mass in every frame, by code of the tests. [m]
[[nodiscard]] std::vector<double> judged_heights(const Motion& motion);

}  // namespace marey::testing
