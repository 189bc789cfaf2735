// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/select_clips.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/library/library_index.h"
#include "tests/support/files/run_sql.h"
#include "tests/support/files/simulated_records.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// An index of simulated records, open for selections.
class SelectClips : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_library_index(folder_ / "library.sqlite", records_));
  }

  /// Selects, and compares with the same condition on the records.
  void expect_same(const std::function<Result<ClipSet>(const ClipSelector&)>& select,
                   const std::function<bool(const ClipRecord&)>& holds) {
    const auto selector = ClipSelector::open(folder_ / "library.sqlite");
    ASSERT_TRUE(selector) << selector.error().message();
    const auto found = select(*selector);
    ASSERT_TRUE(found) << found.error().message();
    ClipSet expected;
    for (const ClipRecord& record : records_) expected.push_back(holds(record));
    EXPECT_EQ(*found, expected);
    EXPECT_GT(std::count(expected.begin(), expected.end(), true), 0);
  }

  ScratchFolder folder_;
  std::vector<ClipRecord> records_ = testing::simulated_records({300, 20, 10, 4});
};

TEST_F(SelectClips, ByTextsOfTheRecord) {
  expect_same([](const auto& s) { return s.with_text(ClipText::kLicence, "unknown"); },
              [](const auto& r) { return r.provenance.licence == "unknown"; });
  expect_same([](const auto& s) { return s.with_text(ClipText::kSubject, "actor 3"); },
              [](const auto& r) { return r.provenance.subject == "actor 3"; });
  expect_same([](const auto& s) { return s.with_text(ClipText::kBody, "second"); },
              [](const auto& r) { return r.body == "second"; });
  expect_same([](const auto& s) { return s.with_text(ClipText::kMirrorOf, ""); },
              [](const auto& r) { return r.mirror_of.empty(); });
  expect_same(
      [](const auto& s) { return s.with_text(ClipText::kPath, "files/take_00002.bvh"); },
      [](const auto& r) { return r.provenance.path == "files/take_00002.bvh"; });
  expect_same([](const auto& s) { return s.with_part_of_text(ClipText::kName, "WALK"); },
              [](const auto& r) { return r.name.find("walk") != std::string::npos; });
  expect_same(
      [](const auto& s) { return s.with_part_of_text(ClipText::kPath, "take_0000"); },
      [](const auto& r) {
        return r.provenance.path.find("take_0000") != std::string::npos;
      });
}

TEST_F(SelectClips, ByNumbers) {
  expect_same(
      [](const auto& s) {
        return s.with_number(ClipNumber::kSeconds, Comparison::kGreater, 3.0);
      },
      [](const auto& r) { return r.duration_s() > 3.0; });
  expect_same(
      [](const auto& s) {
        return s.with_number(ClipNumber::kRateHz, Comparison::kEqual, 119.88);
      },
      [](const auto& r) { return r.rate_hz == 119.88; });
  expect_same(
      [](const auto& s) {
        return s.with_number(ClipNumber::kFrames, Comparison::kLessEqual, 100.0);
      },
      [](const auto& r) { return r.frame_count() <= 100; });
  expect_same(
      [](const auto& s) {
        return s.with_figure("speed_m_s", Comparison::kGreaterEqual, 1.2);
      },
      [](const auto& r) {
        return std::any_of(r.figures.begin(), r.figures.end(), [](const auto& f) {
          return f.name == "speed_m_s" && f.value >= 1.2;
        });
      });
}

TEST_F(SelectClips, ByLabelsEventsProblemsAndQuality) {
  expect_same([](const auto& s) { return s.with_label("content:walk"); },
              [](const auto& r) {
                return std::any_of(r.labels.begin(), r.labels.end(), [](const auto& l) {
                  return l.text == "content:walk";
                });
              });
  expect_same([](const auto& s) { return s.with_label("hand_right above head", 0.3); },
              [](const auto& r) {
                return std::any_of(r.labels.begin(), r.labels.end(), [](const auto& l) {
                  return l.text == "hand_right above head" && l.end_s - l.start_s >= 0.3;
                });
              });
  expect_same([](const auto& s) { return s.with_part_of_label("Hand"); },
              [](const auto& r) {
                return std::any_of(r.labels.begin(), r.labels.end(), [](const auto& l) {
                  return l.text.find("hand") != std::string::npos;
                });
              });
  expect_same([](const auto& s) { return s.with_event("left.strike"); },
              [](const auto& r) {
                return std::any_of(r.events.begin(), r.events.end(), [](const auto& e) {
                  return e.name == "left.strike";
                });
              });
  expect_same([](const auto& s) { return s.with_quality(Verdict::kWarn); },
              [](const auto& r) { return r.quality == Verdict::kWarn; });
  const std::string kind = [&] {
    for (const ClipRecord& record : records_) {
      if (!record.problems.empty()) return record.problems.front().kind;
    }
    return std::string();
  }();
  expect_same([&](const auto& s) { return s.with_problem(kind); },
              [&](const auto& r) {
                return std::any_of(r.problems.begin(),
                                   r.problems.end(),
                                   [&](const auto& p) { return p.kind == kind; });
              });
}

TEST_F(SelectClips, ByWordsOfNamesAndLabelsButNotOfThoseByMarey) {
  const auto selector = ClipSelector::open(folder_ / "library.sqlite");
  ASSERT_TRUE(selector);
  const auto count = [&](std::vector<std::string> words) {
    const auto found = selector->with_words(words);
    EXPECT_TRUE(found) << found.error().message();
    return found ? std::count(found->begin(), found->end(), true) : -1;
  };
  EXPECT_GT(count({"turn", "left"}), 0);
  EXPECT_GT(count({"LEFT", "turn"}), 0);
  EXPECT_GT(count({"wave-left-hand"}), 0);
  EXPECT_EQ(count({"left-wave-hand"}), 0) << "parts of a word are one after another";
  EXPECT_EQ(count({"bears"}), 0) << "a word of labels by marey only";
  // Text of FTS5's own language is text.
  for (const char* word : {"\"", "NOT", "*", "name:", "(", "\"\"\"", "a\" OR \"b", ""}) {
    EXPECT_GE(count({word}), 0) << word;
  }
  EXPECT_EQ(count({"walk\" OR \"jump"}), 0);
}

TEST_F(SelectClips, NeverRunsAValue) {
  const auto selector = ClipSelector::open(folder_ / "library.sqlite");
  ASSERT_TRUE(selector);
  for (const char* value : {"' OR 1=1 --", "'; DROP TABLE clip; --", "%", "_", "?"}) {
    const auto none = ClipSet(records_.size(), false);
    EXPECT_EQ(*selector->with_text(ClipText::kLicence, value), none) << value;
    EXPECT_EQ(*selector->with_label(value), none) << value;
    EXPECT_EQ(*selector->with_part_of_label(std::string("xyz") + value), none) << value;
    EXPECT_EQ(*selector->with_event(value), none) << value;
    EXPECT_EQ(*selector->with_figure(value, Comparison::kLess, 1e9), none) << value;
  }
}

TEST_F(SelectClips, ListsTheWordsOfTheLibrary) {
  const auto selector = ClipSelector::open(folder_ / "library.sqlite");
  ASSERT_TRUE(selector);
  EXPECT_EQ(selector->clip_count(), 300);
  EXPECT_EQ(selector->words(WordKind::kFigure)->size(), 20u);
  EXPECT_EQ(*selector->words(WordKind::kEvent),
            (std::vector<std::string>{"left.strike", "right.strike"}));
  EXPECT_EQ(*selector->words(WordKind::kSplit),
            (std::vector<std::string>{"test", "train", "val"}));
  const auto labels = *selector->words(WordKind::kLabel);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), "content:walk"), 1);
}

TEST_F(SelectClips, RefusesDamage) {
  testing::run_sql(folder_ / "library.sqlite", "DROP TABLE label");
  const auto selector = ClipSelector::open(folder_ / "library.sqlite");
  ASSERT_TRUE(selector);
  const auto found = selector->with_label("content:walk");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message().find("marey library build"), std::string::npos);
  EXPECT_FALSE(ClipSelector::open(folder_ / "none.sqlite"));
}

}  // namespace
}  // namespace marey::recordings
