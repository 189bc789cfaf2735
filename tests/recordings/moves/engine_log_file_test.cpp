// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/engine_log_file.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/base/split_mix.h"
#include "recordings/base/atomic_file.h"
#include "recordings/moves/page_sums.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

EngineLog random_log(std::uint64_t seed) {
  SplitMix random(seed);
  const auto random_text = [&] {
    std::string out;
    for (std::size_t i = random.below(12); i > 0; --i) {
      out += static_cast<char>(random.below(256));
    }
    return out;
  };
  EngineLog log;
  log.step_hz = 60.0;
  log.steps = static_cast<std::int64_t>(random.below(1000));
  log.characters = {random_text(), random_text()};
  log.clips = {"walk 0123", random_text()};
  for (std::size_t i = random.below(20); i > 0; --i) {
    EngineRequest request;
    request.step = static_cast<std::int64_t>(random.below(1000)) - 5;
    request.character = static_cast<int>(random.below(9)) - 1;
    request.kind = random_text();
    for (std::size_t n = random.below(6); n > 0; --n) {
      request.numbers.push_back(random.unit() - 0.5);
    }
    request.numbers.push_back(std::numeric_limits<double>::infinity());
    request.texts = {random_text()};
    log.requests.push_back(request);
  }
  return log;
}

TEST(EngineLogFile, ReadsBackTheSameLog) {
  const testing::ScratchFolder folder;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const EngineLog log = random_log(seed);
    ASSERT_TRUE(write_engine_log(folder / "run.log", log));
    const auto read = read_engine_log(folder / "run.log");
    ASSERT_TRUE(read) << seed;
    EXPECT_EQ(*read, log) << seed;
    EXPECT_EQ(engine_log_bytes(*read), engine_log_bytes(log));
  }
}

TEST(EngineLogFile, RefusesALogThatIsCutShortAnywhere) {
  const std::string bytes = engine_log_bytes(random_log(3));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(parse_engine_log(bytes.substr(0, size), "run.log")) << size;
  }
  ASSERT_FALSE(parse_engine_log(bytes + "0", "run.log"));
}

TEST(EngineLogFile, RefusesADamagedByte) {
  const std::string bytes = engine_log_bytes(random_log(5));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    const auto log = parse_engine_log(damaged, "run.log");
    ASSERT_FALSE(log) << at;
    EXPECT_EQ(log.error().where, "run.log");
  }
}

// The sum is right, but the counts are not those of the content.
TEST(EngineLogFile, RefusesCountsBeyondItsEnd) {
  const std::string whole = engine_log_bytes(random_log(7));
  const std::string content = whole.substr(0, whole.size() - 32);
  SplitMix random(11);
  for (int i = 0; i < 2000; ++i) {
    std::string changed = content;
    const std::size_t at = 19 + random.below(changed.size() - 19);
    changed[at] = static_cast<char>(random.below(256));
    if (random.below(2) == 0) changed.resize(at);
    const auto log = parse_engine_log(changed + blob_sum(changed), "run.log");
    if (log) {
      EXPECT_EQ(engine_log_bytes(*log), changed + blob_sum(changed));
    }
  }
}

TEST(EngineLogFile, NamesANewerVersionAndOtherFiles) {
  const auto newer = parse_engine_log("marey engine log 2\n", "run.log");
  ASSERT_FALSE(newer);
  EXPECT_NE(newer.error().cause.find("another version"), std::string::npos);
  const auto other = parse_engine_log("SQLite format 3", "run.log");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().cause.find("no log"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
