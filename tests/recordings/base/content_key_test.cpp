// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/content_key.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
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

// Pins the hash: `printf a | xxh128sum` prints it.
TEST(ContentKey, IsSizeAndXxh3OfTheWholeFile) {
  EXPECT_EQ(key_of_bytes("a"), "1-a96faf705af16834e6c632b61e964e1f");
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

// Three MiB, and no multiple of the pieces that are read.
TEST(ContentKey, ChangesWithAByteInTheMiddle) {
  std::string bytes((3U << 20) + 17, 'x');
  const std::string before = key_of_bytes(bytes);
  for (const std::size_t at :
       {bytes.size() / 2, std::size_t{1} << 20, (std::size_t{1} << 20) - 1}) {
    bytes[at] = 'y';
    EXPECT_NE(key_of_bytes(bytes), before) << at;
    bytes[at] = 'x';
  }
  EXPECT_EQ(key_of_bytes(bytes), before);
}

TEST(ContentKey, ChangesWithTheSize) {
  EXPECT_NE(key_of_bytes(std::string(3U << 20, 'x')),
            key_of_bytes(std::string((3U << 20) + 1, 'x')));
}

TEST(ContentKey, StaysForTheSameBytes) {
  EXPECT_EQ(key_of_bytes("abc"), key_of_bytes("abc"));
}

TEST(ContentKey, KnowsAnEmptyFile) {
  EXPECT_EQ(key_of_bytes(""), "0-99aa06d3014798d86001c324468d497f");
}

TEST(ContentKey, ChangesWithNamesAndSizesInAFolder) {
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
TEST(ContentKey, ChangesWithTheBytesOfAFileInAFolder) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "1.png", "a"));
  ASSERT_TRUE(write_file(folder / "2.png", "a"));
  const std::string before = *content_key(folder.path());
  ASSERT_TRUE(write_file(folder / "2.png", "b"));
  EXPECT_NE(*content_key(folder.path()), before);
  ASSERT_TRUE(write_file(folder / "2.png", "a"));
  EXPECT_EQ(*content_key(folder.path()), before);
}

TEST(ContentKey, DeclinesAMissingFile) {
  const ScratchFolder folder;
  const Result<std::string> key = content_key(folder / "absent.mp4");
  ASSERT_FALSE(key);
  EXPECT_EQ(key.error().code, Errc::kBadInput);
}

}  // namespace
}  // namespace marey::recordings
