// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/text/content_key.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/text/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

std::string key_of_bytes(const std::string& bytes) {
  const ScratchFolder folder;
  EXPECT_TRUE(write_file(folder / "a.mp4", bytes));
  const Result<std::string> key = content_key(folder / "a.mp4");
  EXPECT_TRUE(key);
  return key ? *key : "";
}

// Pins the hash: "a" twice (first and last MiB are the same byte), FNV-1a 64.
TEST(ContentKey, IsSizeAndFnvOfFirstAndLastMebibyte) {
  EXPECT_EQ(key_of_bytes("a"), "1-089c4307b54596b7");
}

TEST(ContentKey, ChangesWithTheFirstAndTheLastByte) {
  std::string bytes(3U << 20, 'x');
  const std::string before = key_of_bytes(bytes);
  bytes.front() = 'y';
  EXPECT_NE(key_of_bytes(bytes), before);
  bytes.front() = 'x';
  bytes.back() = 'y';
  EXPECT_NE(key_of_bytes(bytes), before);
}

TEST(ContentKey, ChangesWithTheSize) {
  EXPECT_NE(key_of_bytes(std::string(3U << 20, 'x')),
            key_of_bytes(std::string((3U << 20) + 1, 'x')));
}

TEST(ContentKey, StaysForTheSameBytes) {
  EXPECT_EQ(key_of_bytes("abc"), key_of_bytes("abc"));
}

TEST(ContentKey, KnowsAnEmptyFile) {
  EXPECT_EQ(key_of_bytes(""), "0-cbf29ce484222325");
}

TEST(ContentKey, OfAFolderChangesWithNamesAndSizes) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "1.png", "a"));
  const std::string one = *content_key(folder.path());
  ASSERT_TRUE(write_file(folder / "2.png", "a"));
  const std::string two = *content_key(folder.path());
  ASSERT_TRUE(write_file(folder / "2.png", "ab"));
  const std::string longer = *content_key(folder.path());
  EXPECT_NE(one, two);
  EXPECT_NE(two, longer);
}

// Raw frames of a camera all have one size.
TEST(ContentKey, OfAFolderChangesWithTheBytesOfAFile) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "1.png", "a"));
  ASSERT_TRUE(write_file(folder / "2.png", "a"));
  const std::string before = *content_key(folder.path());
  ASSERT_TRUE(write_file(folder / "2.png", "b"));
  EXPECT_NE(*content_key(folder.path()), before);
  ASSERT_TRUE(write_file(folder / "2.png", "a"));
  EXPECT_EQ(*content_key(folder.path()), before);
}

TEST(ContentKey, DeclinesWhatIsNotThere) {
  const ScratchFolder folder;
  const Result<std::string> key = content_key(folder / "absent.mp4");
  ASSERT_FALSE(key);
  EXPECT_EQ(key.error().code, Errc::kBadInput);
}

}  // namespace
}  // namespace marey::recordings
