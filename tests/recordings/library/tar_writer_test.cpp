// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/tar_writer.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::run_program;
using testing::ScratchFolder;

Status write_tar_sample(const std::filesystem::path& path) {
  auto tar = TarWriter::create(path);
  if (!tar) return tar.error();
  tar->add("a.json", "{}");
  tar->add("empty", "");
  tar->add(std::string(100, 'n'), std::string(512, 'x'));
  tar->add("folder/b.npz", std::string(100000, '\xff'));
  EXPECT_EQ(tar->size(), 1024 + 512 + 1024 + (512 + 100352) + 1024u);
  return tar->commit();
}

TEST(TarWriter, WritesArchivesThatPythonAndTarRead) {
  const ScratchFolder folder;
  const auto path = folder / "a.tar";
  ASSERT_TRUE(write_tar_sample(path));
  EXPECT_EQ(std::filesystem::file_size(path), 1024 + 512 + 1024 + 100864 + 1024u);
  const auto python = run_program(
      "/usr/bin/python3",
      {"-c",
       "import sys, tarfile\n"
       "t = tarfile.open(sys.argv[1], 'r:')\n"
       "m = t.getmembers()\n"
       "assert [x.name for x in m] == ['a.json', 'empty', 'n' * 100, 'folder/b.npz']\n"
       "assert all(x.isreg() and x.mtime == 0 and x.uid == 0 and x.gid == 0\n"
       "           and x.mode == 0o644 and x.uname == '' for x in m)\n"
       "assert t.extractfile(m[0]).read() == b'{}'\n"
       "assert t.extractfile(m[1]).read() == b''\n"
       "assert t.extractfile(m[2]).read() == b'x' * 512\n"
       "assert t.extractfile(m[3]).read() == b'\\xff' * 100000\n",
       path.string()});
  EXPECT_EQ(python.exit_code, 0) << python.err;
  const auto tar = run_program("/usr/bin/tar", {"tf", path.string()});
  EXPECT_EQ(tar.exit_code, 0) << tar.err;
  EXPECT_TRUE(tar.err.empty()) << tar.err;
}

TEST(TarWriter, WritesTheSameBytesTwice) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_tar_sample(folder / "a.tar"));
  ASSERT_TRUE(write_tar_sample(folder / "b.tar"));
  EXPECT_EQ(*read_file(folder / "a.tar"), *read_file(folder / "b.tar"));
}

TEST(TarWriter, LeavesNothingWithoutCommit) {
  const ScratchFolder folder;
  {
    auto tar = TarWriter::create(folder / "a.tar");
    ASSERT_TRUE(tar);
    tar->add("a", "b");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace marey::recordings
