// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/sha256.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

// Examples of NIST for FIPS 180-4 (SHA256.pdf), and the empty message of its SHAVS.
constexpr const char* kOfNothing =
    "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr const char* kOfAbc =
    "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* kOfTwoBlocks =
    "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1";
constexpr const char* kOfAMillion =
    "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256, GivesThePublishedSums) {
  EXPECT_EQ(sha256(""), kOfNothing);
  EXPECT_EQ(sha256("abc"), kOfAbc);
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            kOfTwoBlocks);
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')), kOfAMillion);
}

TEST(Sha256, IsTheSameForAFileAndItsBytes) {
  const testing::ScratchFolder folder;
  // Longer than one piece, and no multiple of one.
  std::string bytes;
  for (int i = 0; i < 3'000'001; ++i) bytes += static_cast<char>(i * 7 % 251);
  for (const std::string& content : {bytes, std::string("abc"), std::string()}) {
    ASSERT_TRUE(write_file(folder / "file", content));
    const Result<std::string> sum = sha256_of_file(folder / "file");
    ASSERT_TRUE(sum) << sum.error().message();
    EXPECT_EQ(*sum, sha256(content));
  }
}

TEST(Sha256, RefusesAMissingFileAndAFolder) {
  const testing::ScratchFolder folder;
  for (const auto& path : {folder / "missing", folder.path()}) {
    const Result<std::string> sum = sha256_of_file(path);
    ASSERT_FALSE(sum);
    EXPECT_EQ(sum.error().code, Errc::kBadInput);
    EXPECT_EQ(sum.error().where, path.string());
    EXPECT_FALSE(sum.error().next.empty());
  }
}

}  // namespace
}  // namespace marey::recordings
