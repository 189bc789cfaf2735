// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/library/build/walk_library.h"

#include <stdexcept>

#include "core/base/format_text.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/motion/bvh.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

void write_or_throw(const fs::path& file, const std::string& text) {
  if (!recordings::write_file(file, text)) throw std::runtime_error(file.string());
}

}  // namespace

WalkLibrary::WalkLibrary(int count) {
  for (int number = 1; number <= count; ++number) {
    const double hz = number % 2 == 0 ? 30.0 : 60.0;
    const testing::SyntheticWalk simulated =
        testing::synthetic_walk(60 + 10 * number, hz, 0.002 * number);
    write_or_throw(walk(number), recordings::bvh_text(simulated.motion));
  }
}

fs::path WalkLibrary::walk(int number) const {
  return walks() / format_text("%02d.bvh", number);
}

fs::path WalkLibrary::make(const std::string& name, const std::string& settings) const {
  const fs::path library = scratch_ / name;
  write_or_throw(library / "library.toml",
                 "format = 1\nname = \"walks\"\n" + settings + "\n[[source]]\npath = \"" +
                     walks().string() + "\"\nlicence = \"CC0-1.0\"\n");
  return library;
}

std::map<std::string, std::string> built_files(const fs::path& library) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(library)) {
    const std::string name = entry.path().lexically_relative(library).string();
    const bool is_input = name == "library.toml" || name.starts_with("labels");
    if (!entry.is_regular_file() || is_input || name.starts_with(".cache")) continue;
    out[name] = *recordings::sha256_of_file(entry.path());
  }
  return out;
}

}  // namespace marey::app
