// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/live_take.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/sqlite.h"
#include "recordings/takes/view_bytes.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

TagDetection tag(int id, double x) {
  TagDetection one;
  one.id = TagId{id};
  one.corners_px = {{{x, 10.0 / 3.0}, {x + 20, 11}, {x + 21, 31}, {x + 1, 30.1}}};
  one.sigma_px = 0.17;
  one.decision_margin = 61.25;
  one.hamming = 1;
  return one;
}

LiveTakeHead head() {
  return {"garden", "2026-11-22T10:00:00Z", {30.0}, {"left", "right"}, "{\"rest\":1}"};
}

LiveTakeInstant instant(std::int64_t number) {
  LiveTakeInstant one;
  one.seen.number = number;
  one.seen.time = Timestamp{number * 33'333'333};
  one.seen.views.push_back({CameraId{0}, one.seen.time - Timestamp{5}, {tag(40, 1e-3)}});
  one.seen.views.push_back(
      {CameraId{1}, one.seen.time + Timestamp{7}, {tag(3, 100.1), tag(41, 640.0)}});
  one.requests = number % 2 == 0 ? "" : "{\"type\":\"drag\"}";
  one.results = {std::byte{0}, std::byte{255}, static_cast<std::byte>(number)};
  return one;
}

void expect_same(const LiveTakeInstant& a, const LiveTakeInstant& b) {
  EXPECT_EQ(a.seen.number, b.seen.number);
  EXPECT_EQ(a.seen.time, b.seen.time);
  EXPECT_EQ(a.requests, b.requests);
  EXPECT_EQ(a.results, b.results);
  std::vector<std::byte> of_a;
  std::vector<std::byte> of_b;
  write_views(a.seen.views, of_a);
  write_views(b.seen.views, of_b);
  EXPECT_EQ(of_a, of_b);
}

TEST(LiveTake, KeepsNoMoreThanSoManyForADiskThatStandsStill) {
  const testing::ScratchFolder folder;
  const auto file = folder.path() / kLiveTakeFile;
  auto writer = LiveTakeWriter::create(file, head());
  ASSERT_TRUE(writer);
  constexpr auto kMaxCount = static_cast<std::int64_t>(LiveTakeWriter::kMaxWaiting);
  for (std::int64_t i = 0; i < kMaxCount; ++i) ASSERT_TRUE(writer->add(instant(i)));
  const Status full = writer->add(instant(kMaxCount));
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, Errc::kDevice);
  ASSERT_TRUE(writer->finish());
  const auto take = read_live_take(file);
  ASSERT_TRUE(take);
  EXPECT_EQ(take->instants.size(), LiveTakeWriter::kMaxWaiting);
}

TEST(LiveTake, KeepsEveryNumberExactly) {
  const testing::ScratchFolder folder;
  const auto file = folder.path() / kLiveTakeFile;
  auto writer = LiveTakeWriter::create(file, head());
  ASSERT_TRUE(writer);
  for (const std::int64_t number : {3, 4, 7}) EXPECT_TRUE(writer->add(instant(number)));
  ASSERT_TRUE(writer->finish());
  const auto take = read_live_take(file);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_TRUE(take->finished);
  EXPECT_EQ(take->head.session, "garden");
  EXPECT_EQ(take->head.started, head().started);
  EXPECT_EQ(take->head.rate.hz, 30.0);
  EXPECT_EQ(take->head.cameras, head().cameras);
  EXPECT_EQ(take->head.settings, head().settings);
  ASSERT_EQ(take->instants.size(), 3U);
  expect_same(take->instants[0], instant(3));
  expect_same(take->instants[1], instant(4));
  expect_same(take->instants[2], instant(7));
}

// As after `kill -9`, without finish().
TEST(LiveTake, KeepsCommittedFramesAfterATruncation) {
  const testing::ScratchFolder folder;
  const auto file = folder.path() / kLiveTakeFile;
  auto writer = LiveTakeWriter::create(file, head());
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->add(instant(1)));
  ASSERT_TRUE(writer->commit());
  EXPECT_TRUE(writer->add(instant(2)));
  const auto take = read_live_take(file);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_FALSE(take->finished);
  ASSERT_EQ(take->instants.size(), 1U);
  expect_same(take->instants[0], instant(1));
}

std::map<std::string, std::string> content_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path(), std::ios::binary);
    files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return files;
}

// The files of a killed process can be read any number of times, and do not change.
TEST(LiveTake, IsReadWithoutAWriteWhetherItWasFinishedOrKilled) {
  const testing::ScratchFolder folder;
  const auto file = folder.path() / kLiveTakeFile;
  auto writer = LiveTakeWriter::create(file, head());
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->add(instant(1)));
  ASSERT_TRUE(writer->commit());
  // The state after a kill: the file, and a log with the committed data.
  const testing::ScratchFolder killed;
  for (const auto& [name, bytes] : content_of(folder.path())) {
    if (name.ends_with("-shm")) continue;
    std::ofstream(killed / name, std::ios::binary) << bytes;
  }
  ASSERT_TRUE(writer->finish());
  for (const auto* where : {&folder, &killed}) {
    const auto before = content_of(where->path());
    for (int i = 0; i < 2; ++i) {
      const auto take = read_live_take(where->path() / kLiveTakeFile);
      ASSERT_TRUE(take) << take.error().message();
      EXPECT_EQ(take->finished, where == &folder);
      ASSERT_EQ(take->instants.size(), 1U);
      expect_same(take->instants[0], instant(1));
    }
    EXPECT_EQ(content_of(where->path()), before);
  }
  EXPECT_EQ(content_of(killed.path()).size(), 2U) << "the file and its log";
}

TEST(LiveTake, DeclinesNumbersAndTimesThatNoRunHas) {
  for (const char* change : {"UPDATE instant SET number = 9000000000000000000",
                             "UPDATE instant SET number = -9000000000000000000",
                             "UPDATE instant SET time_ns = 9000000000000000000",
                             "UPDATE instant SET time_ns = 3600000000000",
                             "UPDATE live SET rate_hz = 1e30",
                             "UPDATE live SET rate_hz = 9e999"}) {
    const testing::ScratchFolder folder;
    const auto file = folder.path() / kLiveTakeFile;
    {
      auto writer = LiveTakeWriter::create(file, head());
      ASSERT_TRUE(writer);
      EXPECT_TRUE(writer->add(instant(1)));
      ASSERT_TRUE(writer->finish());
    }
    {
      const Database database = open_database(file, SQLITE_OPEN_READWRITE);
      ASSERT_TRUE(execute(database.get(), change)) << change;
    }
    const auto take = read_live_take(file);
    ASSERT_FALSE(take) << change;
    EXPECT_EQ(take.error().code, Errc::kBadInput);
  }
}

TEST(LiveTake, NeverWritesOverAnother) {
  const testing::ScratchFolder folder;
  const auto file = folder.path() / kLiveTakeFile;
  ASSERT_TRUE(LiveTakeWriter::create(file, head()));
  const auto again = LiveTakeWriter::create(file, head());
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Errc::kBadInput);
  EXPECT_TRUE(read_live_take(file));
}

TEST(LiveTake, ReportsAMissingFileOrAnotherFormat) {
  const testing::ScratchFolder folder;
  const auto missing = read_live_take(folder.path() / kLiveTakeFile);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kBadInput);
  const auto other = folder.path() / "other.sqlite";
  std::ofstream(other) << "not a database, whatever it is called";
  const auto read = read_live_take(other);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().cause.find("damaged"), std::string::npos);
}

TEST(LiveTake, RefusesWhatItWouldNotWrite) {
  const testing::ScratchFolder folder;
  const auto file = folder.path() / kLiveTakeFile;
  {
    auto writer = LiveTakeWriter::create(file, head());
    ASSERT_TRUE(writer);
    EXPECT_TRUE(writer->add(instant(1)));
    ASSERT_TRUE(writer->finish());
  }
  {
    const Database database = open_database(file, SQLITE_OPEN_READWRITE);
    ASSERT_TRUE(execute(database.get(), "UPDATE instant SET views = x'0100'"));
  }
  EXPECT_FALSE(read_live_take(file));
}

TEST(ViewBytes, AreRefusedAtEveryLengthButTheirOwn) {
  std::vector<std::byte> bytes;
  write_views(instant(9).seen.views, bytes);
  ASSERT_TRUE(read_views(bytes, 2));
  EXPECT_FALSE(read_views(bytes, 1)) << "a camera that does not exist";
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(read_views(std::span(bytes).first(size), 2)) << size;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(read_views(bytes, 2));
}

TEST(ViewBytes, AreRefusedWithValuesThatNoDetectorGives) {
  const auto survives = [](const auto& spoil) {
    LiveTakeInstant one = instant(9);
    spoil(one.seen.views);
    std::vector<std::byte> bytes;
    write_views(one.seen.views, bytes);
    return read_views(bytes, 2).has_value();
  };
  using Views = std::vector<CameraTags>;
  EXPECT_TRUE(survives([](Views&) {}));
  EXPECT_FALSE(survives([](Views& v) {
    v[0].tags[0].corners_px[2].y = std::numeric_limits<double>::quiet_NaN();
  }));
  EXPECT_FALSE(survives([](Views& v) {
    v[1].tags[1].decision_margin = std::numeric_limits<double>::infinity();
  }));
  EXPECT_FALSE(survives([](Views& v) { v[0].tags[0].sigma_px = 0.0; }));
  EXPECT_FALSE(survives([](Views& v) { std::swap(v[1].tags[0], v[1].tags[1]); }));
  EXPECT_FALSE(survives([](Views& v) { std::swap(v[0], v[1]); }));
}

}  // namespace
}  // namespace marey::recordings
