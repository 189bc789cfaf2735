// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/shard_plan.h"

#include <algorithm>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

std::vector<SourceFile> random_sources(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::vector<SourceFile> out;
  for (std::size_t i = 0; i < count; ++i) {
    SourceFile& file = out.emplace_back();
    file.name = "walk" + std::to_string(i) + ".bvh";
    file.path = "/data/" + file.name;
    file.kind = "bvh";
    file.bytes = random() % 1'000'000;
  }
  return out;
}

std::uintmax_t bytes_of(const std::vector<SourceFile>& files) {
  std::uintmax_t out = 0;
  for (const SourceFile& file : files) out += file.bytes;
  return out;
}

TEST(ShardPlan, DividesEverySourceIntoOneShard) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const auto sources = random_sources(seed, 3 + seed * 7 % 100);
    const int shards = 1 + static_cast<int>(seed % 9);
    const auto lists = divide_sources(sources, shards);
    ASSERT_EQ(lists.size(), static_cast<std::size_t>(shards));
    std::multiset<std::string> names;
    std::uintmax_t largest = 0;
    for (const auto& list : lists) {
      for (const SourceFile& file : list) names.insert(file.name);
      largest = std::max(largest, bytes_of(list));
    }
    EXPECT_EQ(names.size(), sources.size());
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), sources.size());
    // No shard is larger than its share by more than the largest source.
    constexpr std::uintmax_t kLargestSource = 1'000'000 + 100;
    EXPECT_LE(largest,
              bytes_of(sources) / static_cast<std::uintmax_t>(shards) + kLargestSource);
  }
}

TEST(ShardPlan, DoesNotDependOnTheOrderOfSources) {
  auto sources = random_sources(4, 40);
  const auto lists = divide_sources(sources, 4);
  std::ranges::reverse(sources);
  const auto other = divide_sources(sources, 4);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    ASSERT_EQ(lists[i].size(), other[i].size());
    for (std::size_t k = 0; k < lists[i].size(); ++k) {
      EXPECT_EQ(lists[i][k].name, other[i][k].name);
    }
  }
}

TEST(ShardPlan, ReadsWhatItWrote) {
  const testing::ScratchFolder library;
  const auto lists = divide_sources(random_sources(1, 5), 2);
  ASSERT_TRUE(write_shard_plan(library.path(), {"digest", 2}, lists));
  const auto plan = read_shard_plan(library.path());
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->inputs, "digest");
  EXPECT_EQ(unfinished_shards(library.path(), *plan), (std::vector<int>{1, 2}));
  const auto list = read_shard_list(library.path(), *plan, 2, 1);
  ASSERT_TRUE(list);
  ASSERT_EQ(list->size(), lists[1].size());
  EXPECT_EQ(list->front().path, lists[1].front().path);
  EXPECT_EQ(list->front().bytes, lists[1].front().bytes);
  SourceOutcome outcome;
  outcome.name = "a \"quoted\"\nname";
  outcome.failure = bad_input("line 3", "no number", "correct it");
  ASSERT_TRUE(write_shard_outcomes(library.path(), *plan, 2, {outcome}));
  const auto outcomes = read_shard_outcomes(library.path(), *plan, 2);
  ASSERT_TRUE(outcomes);
  EXPECT_EQ(outcomes->front().name, outcome.name);
  EXPECT_EQ(outcomes->front().failure->message(), outcome.failure->message());
  EXPECT_EQ(unfinished_shards(library.path(), *plan), std::vector<int>{1});
  // Outcomes and lists of another plan are recognised.
  const auto other = divide_sources(random_sources(2, 5), 2);
  ASSERT_TRUE(write_shard_plan(library.path(), {"digest", 2}, other));
  EXPECT_FALSE(write_shard_outcomes(library.path(), *plan, 1, {outcome}));
  const auto current = read_shard_plan(library.path());
  ASSERT_TRUE(current);
  EXPECT_FALSE(read_shard_outcomes(library.path(), *current, 2));
  EXPECT_FALSE(read_shard_list(library.path(), *plan, 2, 1));
  EXPECT_FALSE(read_shard_list(library.path(), *current, 2, 0)) << "an unknown source";
  remove_shards(library.path());
  EXPECT_FALSE(read_shard_plan(library.path()));
}

TEST(ShardPlan, TheScriptQuotesItsPaths) {
  const std::string script = slurm_script("/opt/marey", "/data/my lib's", 7);
  EXPECT_NE(script.find("--array=1-7"), std::string::npos);
  EXPECT_NE(script.find("afterany"), std::string::npos);
  EXPECT_NE(script.find("merge"), std::string::npos);
  EXPECT_EQ(script.find("/data/my lib's "), std::string::npos) << script;
}

}  // namespace
}  // namespace marey::app
