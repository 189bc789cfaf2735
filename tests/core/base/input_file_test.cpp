// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/input_file.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/program/scratch_folder.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

std::string cause(const fs::path& path) {
  const Status ok = check_input_file(path);
  if (ok) return "";
  EXPECT_EQ(ok.error().code, Errc::kBadInput);
  EXPECT_EQ(ok.error().where, path.string());
  EXPECT_FALSE(ok.error().next.empty());
  return ok.error().cause;
}

TEST(InputFile, IsARegularFileOrALinkToOne) {
  const testing::ScratchFolder folder;
  std::ofstream(folder / "a.txt") << "a";
  EXPECT_EQ(cause(folder / "a.txt"), "");
  fs::create_symlink("a.txt", folder / "link");
  EXPECT_EQ(cause(folder / "link"), "");
}

// A pipe would be waited for for ever, and a device never ends.
TEST(InputFile, IsNothingElse) {
  const testing::ScratchFolder folder;
  EXPECT_EQ(cause(folder / "missing"), "the file does not exist");
  fs::create_symlink("missing", folder / "dangling");
  EXPECT_EQ(cause(folder / "dangling"), "the file does not exist");
  EXPECT_EQ(cause(folder.path()), "this is a folder, not a file");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(cause(folder / "pipe"), "this is a pipe, not a file");
  fs::create_symlink("/dev/zero", folder / "zero.bvh");
  EXPECT_EQ(cause("/dev/zero"), "this is a device, not a file");
  EXPECT_EQ(cause(folder / "zero.bvh"), "this is a device, not a file");
  EXPECT_NE(cause(folder / "missing/a.txt"), "");
}

TEST(InputFile, IsCalledAsItsReaderCallsIt) {
  const Status ok = check_input_file("/dev/zero", "walk/cam0.mp4");
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().where, "walk/cam0.mp4");
}

}  // namespace
}  // namespace marey
