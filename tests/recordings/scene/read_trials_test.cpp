// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_trials.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

TrialList page_list() {
  const Result<TrialList> list = parse_trials(testing::formats_example("trials"), "page");
  EXPECT_TRUE(list) << (list ? "" : list.error().message());
  return list ? *list : TrialList{};
}

TEST(TrialsFile, ReadsTheExampleOfTheDocumentation) {
  const TrialList list = page_list();
  EXPECT_EQ(list.seed, 20U);
  EXPECT_EQ(list.order, TrialOrder::kBlocks);
  ASSERT_EQ(list.trials.size(), 6U);
  EXPECT_EQ(list.trials[0].parameter, ThrowParameter::kCaptured);
  EXPECT_EQ(list.trials[3].parameter, ThrowParameter::kAzimuth);
  EXPECT_EQ(list.trials[3].value, 8.0);
  EXPECT_EQ(list.trials[5].parameter, ThrowParameter::kSpeed);
  EXPECT_EQ(list.trials[5].repeat, 5);
}

TEST(TrialsFile, ThePageNamesEveryParameter) {
  const std::string page = testing::formats_page("trials");
  for (const std::string_view word : kThrowParameters) {
    EXPECT_NE(page.find("`\"" + std::string(word) + "\"`"), std::string::npos) << word;
  }
}

TEST(TrialsOrder, HoldsEachRepetitionOnce) {
  TrialList list = page_list();
  for (const TrialOrder order :
       {TrialOrder::kListed, TrialOrder::kShuffled, TrialOrder::kBlocks}) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      list.order = order;
      list.seed = seed;
      const std::vector<PlannedTrial> planned = trial_order(list);
      std::map<std::pair<std::size_t, int>, int> seen;
      for (const PlannedTrial& one : planned) ++seen[{one.trial, one.repetition}];
      EXPECT_EQ(planned.size(), 27U);
      EXPECT_EQ(seen.size(), 27U);
      EXPECT_EQ(trial_order(list), planned);
      if (order != TrialOrder::kBlocks) continue;
      // A block ends before the next repetition begins.
      EXPECT_TRUE(std::is_sorted(
          planned.begin(), planned.end(), [](const auto& a, const auto& b) {
            return a.repetition < b.repetition;
          }));
    }
  }
}

// The numbers of SplitMix64 from seed 0 are published: e220a8397b1dcdaf,
// 6e789e6aa1b965f4. So three throws are exchanged with floor(3 * 0.883) = 2, then
// floor(2 * 0.4315) = 0.
TEST(TrialsOrder, IsTheDocumentedShuffle) {
  TrialList list;
  list.order = TrialOrder::kShuffled;
  list.trials = {{ThrowParameter::kSpeed, 1.0, 1},
                 {ThrowParameter::kSpeed, 2.0, 1},
                 {ThrowParameter::kSpeed, 3.0, 1}};
  EXPECT_EQ(trial_order(list), (std::vector<PlannedTrial>{{1, 0}, {0, 0}, {2, 0}}));
}

TEST(TrialsOrder, ThrowsAreEvenlySpreadOverPlaces) {
  TrialList list;
  list.order = TrialOrder::kShuffled;
  list.trials = {{ThrowParameter::kSpeed, 1.0, 5}};
  std::array<std::array<int, 5>, 5> counts{};
  constexpr int kSeeds = 10'000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    list.seed = seed;
    const auto planned = trial_order(list);
    for (std::size_t k = 0; k < 5; ++k) {
      ++counts[k][static_cast<std::size_t>(planned[k].repetition)];
    }
  }
  for (const auto& row : counts) {
    for (const int count : row) EXPECT_NEAR(count, kSeeds / 5, 200);  // 5 sigma.
  }
}

TEST(TrialsFile, RefusesBrokenFilesWithTheirLine) {
  struct Fault {
    const char* from;
    const char* to;
    int line;
    const char* cause;
    const char* next;
  };
  for (const Fault& fault :
       {Fault{"format = 1",
              "format = 2",
              1,
              "\"format\" is 2, not between 1 and 1",
              "correct the number"},
        Fault{"seed = 20\n",
              "",
              1,
              "the key \"seed\" is missing",
              "add it; docs/formats/trials.md describes it"},
        Fault{"\"blocks\"",
              "\"block\"",
              4,
              "\"order\" cannot be \"block\"",
              "perhaps you mean \"blocks\""},
        Fault{"\"azimuth_deg\"",
              "\"azimut_deg\"",
              11,
              "\"parameter\" cannot be \"azimut_deg\"",
              "perhaps you mean \"azimuth_deg\""},
        Fault{"[-8.0, 0.0, 8.0]",
              "[-8.0, 0.0, 800.0]",
              12,
              "\"values\" contains 800, not between -180 and 180 degrees",
              "give it in degrees"},
        Fault{"[-8.0, 0.0, 8.0]",
              "[-8.0, 0.0, -8.0]",
              12,
              "the throw \"azimuth_deg = -8\" is listed twice",
              "list it once, and set \"repeat\""},
        Fault{"[-8.0, 0.0, 8.0]",
              "[]",
              12,
              "\"values\" is empty",
              "give one value or more"},
        Fault{"[-8.0, 0.0, 8.0]",
              "[nan]",
              12,
              "\"values\" must be an array of 1 numbers",
              "write it as docs/formats/trials.md shows"},
        Fault{"\"captured\"",
              "\"captured\"\nvalues = [1.0]",
              8,
              "\"captured\" has no values",
              "remove \"values\""},
        Fault{"repeat = 5",
              "repeat = 0",
              13,
              "\"repeat\" is 0, not between 1 and 1000",
              "correct the number"},
        Fault{"repeat",
              "repeats",
              8,
              "unknown key \"repeats\" in [[throw]]",
              "perhaps you mean \"repeat\""}}) {
    std::string text = testing::formats_example("trials");
    const std::size_t at = text.find(fault.from);
    ASSERT_NE(at, std::string::npos) << fault.from;
    text.replace(at, std::string(fault.from).size(), fault.to);
    const Result<TrialList> list = parse_trials(text, "t.toml");
    ASSERT_FALSE(list) << fault.to;
    EXPECT_EQ(list.error().where, "t.toml:" + std::to_string(fault.line)) << fault.to;
    EXPECT_EQ(list.error().cause, fault.cause);
    EXPECT_EQ(list.error().next, fault.next);
  }
}

}  // namespace
}  // namespace marey::recordings
