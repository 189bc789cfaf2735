// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/moves/moves_schema.h"
#include "recordings/moves/pack_frames.h"
#include "recordings/moves/page_sums.h"
#include "recordings/moves/read_moves.h"
#include "recordings/moves/write_moves.h"
#include "tests/support/files/random_moves.h"
#include "tests/support/files/run_sql.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

std::string small_base(std::uint32_t seed) {
  auto bytes = moves_bytes(testing::random_moves(2, 20, seed), "moves.marey");
  EXPECT_TRUE(bytes);
  return *std::move(bytes);
}

void expect_refused(const std::string& bytes, const std::string& cause) {
  const auto read = parse_moves(bytes, "moves.marey");
  ASSERT_FALSE(read) << cause;
  EXPECT_EQ(read.error().code, Errc::kBadInput);
  EXPECT_EQ(read.error().where.rfind("moves.marey", 0), 0U);
  EXPECT_NE(read.error().cause.find(cause), std::string::npos) << read.error().message();
  EXPECT_FALSE(read.error().next.empty());
}

TEST(DamagedMoves, AreRefusedIfCutAnywhere) {
  const std::string whole = small_base(1);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto read = parse_moves(std::string_view(whole).substr(0, size), "moves.marey");
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().code, Errc::kBadInput);
  }
  expect_refused(whole.substr(0, whole.size() - 1), "bytes instead of");
  expect_refused(whole + '\0', "bytes instead of");
}

TEST(DamagedMoves, AreRefusedWhicheverBitIsFlipped) {
  std::mt19937 random(5);
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    std::string bytes = small_base(seed % 10);
    const std::size_t at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << random() % 8);
    const auto read = parse_moves(bytes, "moves.marey");
    ASSERT_FALSE(read) << at;
    EXPECT_EQ(read.error().code, Errc::kBadInput);
  }
}

// With right sums, as in a file that was made to do harm: it is refused or read, and
// all numbers that are read can be written again.
TEST(DamagedMoves, NeverHarmEvenIfTheirPagesHaveRightSums) {
  std::mt19937 random(6);
  int refused = 0;
  constexpr int kFiles = 2000;
  for (int i = 0; i < kFiles; ++i) {
    std::string bytes = small_base(static_cast<std::uint32_t>(i % 10));
    const auto flips = 1 + random() % 8;
    for (unsigned k = 0; k < flips; ++k) {
      const std::size_t at = random() % bytes.size();
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << random() % 8);
    }
    write_page_sums(bytes, kMovesPageBytes);
    const auto read = parse_moves(bytes, "moves.marey");
    if (!read) {
      ++refused;
      continue;
    }
    EXPECT_TRUE(moves_bytes(*read, "again.marey"));
  }
  EXPECT_GT(refused, kFiles / 2);
}

TEST(DamagedMoves, AreRefusedWithPagesOfAnotherPlace) {
  std::string bytes = small_base(2);
  ASSERT_GE(bytes.size(), 4 * kMovesPageBytes);
  std::string swapped = bytes;
  swapped.replace(
      2 * kMovesPageBytes, kMovesPageBytes, bytes, 3 * kMovesPageBytes, kMovesPageBytes);
  expect_refused(swapped, "page 3");
}

TEST(DamagedMoves, WithANewerVersionAreRefusedByIt) {
  std::string bytes = small_base(3);
  bytes[63] = 2;  // The last byte of SQLite's user_version.
  expect_refused(bytes, "newer version of marey (format 2, this version reads 1)");
}

TEST(DamagedMoves, FromAnotherApplicationAreRefused) {
  std::string bytes = small_base(3);
  bytes[71] = 'e';  // The id of a take.
  expect_refused(bytes, "no base of motion clips");
  expect_refused("", "no base of motion clips");
  expect_refused(std::string(5000, 'x'), "no base of motion clips");
}

/// Returns a base that a statement changed, with right sums of its pages.
std::string changed_base(const std::string& statement) {
  const testing::ScratchFolder folder;
  const auto file = folder / "moves.marey";
  EXPECT_TRUE(write_moves(file, testing::random_moves(2, 20, 0)));
  testing::run_sql(file, statement);
  auto bytes = read_file(file);
  EXPECT_TRUE(bytes);
  write_page_sums(*bytes, kMovesPageBytes);
  return *std::move(bytes);
}

TEST(DamagedMoves, AreRefusedWithTheCause) {
  const std::array<std::pair<const char*, const char*>, 16> changes{{
      {"UPDATE clip SET motion = zeroblob(length(motion)) WHERE number = 1",
       "its frames differ from their sum"},
      {"UPDATE clip SET contacts_xxh3 = '' WHERE number = 1",
       "its contacts differ from their sum"},
      {"UPDATE clip SET frames = frames + 1", "another number of frames"},
      {"UPDATE clip SET rate_hz = 9e999", "its rate"},
      {"UPDATE clip SET leg_length_m = -1", "legs"},
      {"UPDATE clip SET name = '' WHERE number = 0", "name"},
      {"UPDATE clip SET name = 'z' WHERE number = 0", "not in order"},
      {"UPDATE clip SET constraints = '<a/>' WHERE number = 0", "constraints"},
      {"UPDATE clip SET turning = 'c9' || char(10)", "turns"},
      {"UPDATE clip SET document_sha256 = 'g'", "document"},
      {"UPDATE base SET clips = 3", "number of clips"},
      {"UPDATE base SET layout = zeroblob(44)", "knots"},
      {"DELETE FROM base", "head"},
      {"UPDATE note SET start_s = 9e999", "note"},
      {"INSERT INTO tag VALUES(7, 'walk')", "not in order"},
      {"DROP INDEX clip_speed", "tables"},
  }};
  for (const auto& [statement, cause] : changes) {
    expect_refused(changed_base(statement), cause);
  }
}

// A blob with a right sum and wrong numbers.
TEST(DamagedMoves, AreRefusedWithNumbersThatNoClipHas) {
  std::string frame(kFrameBytes, '\0');
  const std::string zeros = frame + frame;
  for (std::size_t at = 10; at < kFrameBytes; at += 4) {
    std::string motion = zeros;
    const std::array<unsigned char, 4> nan{0, 0, 0xc0, 0x7f};
    for (std::size_t k = 0; k < 4; ++k) motion[at + k] = static_cast<char>(nan[k]);
    EXPECT_FALSE(unpack_frames(motion)) << at;
  }
  EXPECT_TRUE(unpack_frames(zeros));
  EXPECT_FALSE(unpack_frames(zeros.substr(1)));
}

TEST(DamagedMoves, ThatAreMissingOrAFolderAreRefused) {
  const testing::ScratchFolder folder;
  for (const auto& path : {folder / "missing.marey", folder.path()}) {
    const auto read = read_moves(path);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, Errc::kBadInput);
    EXPECT_EQ(read.error().where, path.string());
  }
}

}  // namespace
}  // namespace marey::recordings
