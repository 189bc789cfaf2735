// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tests/support/program/scratch_folder.h"

namespace marey::app {

/// A folder of simulated walks, and libraries of it.
class WalkLibrary {
 public:
  /// Makes `count` walks: walks/01.bvh, 02.bvh... Each is another motion.
  explicit WalkLibrary(int count);

  [[nodiscard]] std::filesystem::path walks() const { return scratch_ / "walks"; }
  [[nodiscard]] std::filesystem::path walk(int number) const;
  /// Makes a library of all walks, and returns its folder. `settings` are added.
  [[nodiscard]] std::filesystem::path make(const std::string& name,
                                           const std::string& settings = {}) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return scratch_.path(); }

 private:
  testing::ScratchFolder scratch_;
};

/// Returns the SHA-256 of every file that a build made, by its path in the library.
[[nodiscard]] std::map<std::string, std::string> built_files(
    const std::filesystem::path& library);

}  // namespace marey::app
