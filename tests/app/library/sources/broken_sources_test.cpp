// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Sources that are cut short or changed in some bytes, read in child processes.
#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/library/build/process_pool.h"
#include "app/library/sources/read_source.h"
#include "app/library/sources/source_id.h"
#include "recordings/base/atomic_file.h"
#include "tests/app/labelled_session.h"
#include "tests/app/library/sources/source_scene.h"
#include "tests/support/files/bombs.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns whole sources of several kinds.
std::vector<fs::path> whole_sources(const testing::ScratchFolder& folder) {
  EXPECT_TRUE(testing::write_walk(folder / "whole/a.bvh", MotionFormat::kBvh));
  EXPECT_TRUE(testing::write_walk(folder / "whole/a.npz", MotionFormat::kNpz));
  EXPECT_TRUE(testing::write_walk(folder / "whole/a.vrma", MotionFormat::kVrma));
  testing::write_static(folder, "a.c3d");
  testing::write_static(folder, "a.trc");
  EXPECT_TRUE(recordings::write_file(
      folder / "whole/a.edit.toml",
      "format = 1\n[[source]]\npath = \"a.npz\"\n[[op]]\ndo = \"level@1\"\n"));
  return {folder / "whole/a.bvh",
          folder / "whole/a.npz",
          folder / "whole/a.vrma",
          folder / "a.c3d",
          folder / "a.trc",
          folder / "whole/a.edit.toml"};
}

/// Returns the bytes with an end cut off, or with some bytes changed.
std::string spoiled(std::string bytes, std::mt19937& dice) {
  if (bytes.empty()) return bytes;
  if (dice() % 3 == 0) {
    bytes.resize(dice() % bytes.size());
    return bytes;
  }
  const std::size_t changes = 1 + dice() % 20;
  for (std::size_t i = 0; i < changes; ++i) {
    bytes[dice() % bytes.size()] = static_cast<char>(dice() % 256);
  }
  return bytes;
}

/// Writes 500 broken sources: spoiled ones, and files that demand much of their reader.
std::vector<fs::path> broken_sources(const testing::ScratchFolder& folder) {
  constexpr std::size_t kCount = 500;
  std::vector<fs::path> out;
  for (const auto& bombs : {testing::gltf_bombs(),
                            testing::skeleton_bombs(),
                            testing::table_bombs(),
                            testing::npz_bombs()}) {
    for (const testing::Bomb& bomb : bombs) {
      const fs::path path = folder / ("broken/" + bomb.name);
      if (source_kind(path).empty()) continue;
      EXPECT_TRUE(recordings::write_file(path, bomb.bytes));
      out.push_back(path);
    }
  }
  const std::vector<fs::path> whole = whole_sources(folder);
  std::vector<std::string> bytes;
  for (const fs::path& path : whole) bytes.push_back(testing::read_text(path));
  std::mt19937 dice(20);
  for (std::size_t i = 0; out.size() < kCount; ++i) {
    const std::size_t which = i % whole.size();
    const std::string name = whole[which].filename().string();
    const fs::path path = folder / ("broken/" + std::to_string(i) + "_" + name);
    EXPECT_TRUE(recordings::write_file(path, spoiled(bytes[which], dice)));
    out.push_back(path);
  }
  return out;
}

TEST(BrokenSources, NeverCrashTheirReaders) {
  const testing::ScratchFolder folder;
  const std::vector<fs::path> files = broken_sources(folder);
  const auto read = [&](std::size_t i) -> std::string {
    const SourceFile file = testing::source_at(files[i]);
    const auto id = identify_source(file);
    if (!id) return id.error().message();
    const auto motions = read_source(file, {}, {});
    if (!motions) return motions.error().message();
    for (const SourceMotion& motion : *motions) {
      if (motion.motion.poses.empty()) return "a motion without frames";
    }
    return {};
  };
  const auto outcomes =
      run_in_processes(files.size(), 2, read, [](std::size_t) { return true; });
  std::size_t refused = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    ASSERT_TRUE(outcomes[i].is_done)
        << files[i] << ": signal " << outcomes[i].signal.value_or(0);
    const std::string& message = outcomes[i].text;
    if (message.empty()) continue;
    ++refused;
    EXPECT_NE(message.find(files[i].filename().string()), std::string::npos) << message;
    EXPECT_NE(message.find("Next: "), std::string::npos) << message;
  }
  EXPECT_GT(refused, files.size() / 3);
}

}  // namespace
}  // namespace marey::app
