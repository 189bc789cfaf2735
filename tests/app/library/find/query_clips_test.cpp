// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/query_clips.h"

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/library_index.h"
#include "tests/support/files/simulated_records.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using RecordCheck = std::function<bool(const ClipRecord&)>;

bool has_label(const ClipRecord& record, std::string_view text, double min_s = 0.0) {
  return std::any_of(record.labels.begin(), record.labels.end(), [&](const auto& label) {
    return label.text == text && label.end_s - label.start_s >= min_s - 1e-6;
  });
}

double figure_of(const ClipRecord& record, std::string_view name) {
  for (const ClipFigure& figure : record.figures) {
    if (figure.name == name) return figure.value;
  }
  return -1e9;
}

/// A library of 200 simulated clips, without motions.
class QueryClips : public ::testing::Test {
 protected:
  void SetUp() override {
    records_.front().labels.push_back(
        {0.0, 1.0, "a label with 100% 'odd' \"text\"_", "anna", 1.0});
    ASSERT_TRUE(recordings::write_library_index(library_ / "library.sqlite", records_));
  }

  /// The expression selects exactly the records for which `holds`.
  void expect_same(const std::string& expression, const RecordCheck& holds) {
    const auto found = query_clips(library_.path(), expression);
    ASSERT_TRUE(found) << expression << ": " << found.error().message();
    std::vector<int> expected;
    for (std::size_t k = 0; k < records_.size(); ++k) {
      if (holds(records_[k])) expected.push_back(static_cast<int>(k));
    }
    EXPECT_EQ(*found, expected) << expression;
    EXPECT_FALSE(expected.empty()) << expression << " tests nothing";
  }

  std::string refusal(const std::string& expression) {
    const auto found = query_clips(library_.path(), expression);
    return found ? std::string() : found.error().message();
  }

  testing::ScratchFolder library_;
  std::vector<ClipRecord> records_ = testing::simulated_records({200, 20, 10, 6});
};

TEST_F(QueryClips, SelectsByRecordsFiguresAndLabels) {
  expect_same("", [](const auto&) { return true; });
  expect_same("content=walk", [](const auto& r) { return has_label(r, "content:walk"); });
  expect_same("content!=walk",
              [](const auto& r) { return !has_label(r, "content:walk"); });
  expect_same("content=\"turn left\"",
              [](const auto& r) { return has_label(r, "content:turn left"); });
  expect_same("content~a and not content~HAND", [](const auto& r) {
    return std::any_of(r.labels.begin(), r.labels.end(), [](const auto& l) {
      return l.text.starts_with("content:") && l.text != "content:wave-left-hand" &&
             l.text.substr(8).find('a') != std::string::npos;
    });
  });
  expect_same("label=content:run",
              [](const auto& r) { return has_label(r, "content:run"); });
  expect_same("label~\"100% 'odd' \\\"\"",
              [this](const auto& r) { return r.clip_id == records_.front().clip_id; });
  expect_same("quality=pass", [](const auto& r) { return r.quality == Verdict::kPass; });
  expect_same("quality>=warn", [](const auto& r) { return r.quality != Verdict::kPass; });
  expect_same("quality!=fail", [](const auto& r) { return r.quality != Verdict::kFail; });
  expect_same("speed>1.2", [](const auto& r) { return figure_of(r, "speed_m_s") > 1.2; });
  expect_same("speed_m_s<=1.2",
              [](const auto& r) { return figure_of(r, "speed_m_s") <= 1.2; });
  expect_same("sigma_p95>3 and figure.rate<15", [](const auto& r) {
    return figure_of(r, "sigma_p95_mm") > 3.0 && figure_of(r, "rate") < 15.0;
  });
  expect_same("seconds>3 and rate=30",
              [](const auto& r) { return r.duration_s() > 3.0 && r.rate_hz == 30.0; });
  expect_same("frames<100", [](const auto& r) { return r.frame_count() < 100; });
  expect_same("licence!=unknown",
              [](const auto& r) { return r.provenance.licence != "unknown"; });
  expect_same("subject=\"actor 3\"",
              [](const auto& r) { return r.provenance.subject == "actor 3"; });
  expect_same("subject=\"\"", [](const auto& r) { return r.provenance.subject.empty(); });
  expect_same("split=test or split=val",
              [](const auto& r) { return r.split != "train"; });
  expect_same("name~WALK",
              [](const auto& r) { return r.name.find("walk") != std::string::npos; });
  expect_same("source!~take_0000", [](const auto& r) {
    return r.provenance.path.find("take_0000") == std::string::npos;
  });
  expect_same("duplicate=yes", [](const auto& r) { return !r.duplicate_of.empty(); });
  expect_same("duplicate=no and mirror!=yes", [](const auto& r) {
    return r.duplicate_of.empty() && r.mirror_of.empty();
  });
  expect_same("id=" + records_[7].clip_id,
              [&](const auto& r) { return r.clip_id == records_[7].clip_id; });
}

TEST_F(QueryClips, SelectsByRelationsEventsProblemsAndWords) {
  expect_same("has(hand_right above head for 0.3 s)",
              [](const auto& r) { return has_label(r, "hand_right above head", 0.3); });
  expect_same("has(content:jump)",
              [](const auto& r) { return has_label(r, "content:jump"); });
  expect_same("event(left.strike)", [](const auto& r) {
    return std::any_of(r.events.begin(), r.events.end(), [](const auto& e) {
      return e.name == "left.strike";
    });
  });
  expect_same("problem=spike or problem=slide or problem!=swap", [](const auto& r) {
    const auto has = [&](std::string_view kind) {
      return std::any_of(r.problems.begin(), r.problems.end(), [&](const auto& p) {
        return p.kind == kind;
      });
    };
    return has("spike") || has("slide") || !has("swap");
  });
  expect_same("text(\"left turn\")", [](const auto& r) {
    return r.name.find("turn left") != std::string::npos || has_label(r, "turn left") ||
           has_label(r, "content:turn left") ||
           (has_label(r, "wave-left-hand") && has_label(r, "content:turn left"));
  });
}

TEST_F(QueryClips, JoinsConditions) {
  const auto walks = [](const auto& r) { return has_label(r, "content:walk"); };
  const auto fast = [](const auto& r) { return figure_of(r, "speed_m_s") > 1.5; };
  const auto good = [](const auto& r) { return r.quality == Verdict::kPass; };
  expect_same("content=walk and speed>1.5 and quality=pass",
              [&](const auto& r) { return walks(r) && fast(r) && good(r); });
  expect_same("content=walk or speed>1.5 and not quality=pass",
              [&](const auto& r) { return walks(r) || (fast(r) && !good(r)); });
  expect_same("not (content=walk or speed>1.5)",
              [&](const auto& r) { return !walks(r) && !fast(r); });
  expect_same("(content=walk or speed>1.5) and quality=pass",
              [&](const auto& r) { return (walks(r) || fast(r)) && good(r); });
}

TEST_F(QueryClips, NamesTheNearestWordForMistakes) {
  const auto expect = [&](const std::string& expression, std::string_view part) {
    const std::string message = refusal(expression);
    EXPECT_NE(message.find(part), std::string::npos) << expression << ": " << message;
  };
  expect("content=walk and spede>1", "column 18");
  expect("spede_m_s>1", "perhaps you mean \"speed_m_s\"");
  expect("contnt=walk", "perhaps you mean \"content\"");
  expect("xyzzy>1", "\"sparc\"");
  expect("xyzzy>1", "\"xyzzy\" is no figure of this library");
  expect("speed>fast", "column 7");
  expect("speed>fast", "\"fast\" is no number");
  expect("speed>1.2m", "is no number");
  expect("speed>nan", "is no number");
  expect("speed~1", "is a number");
  expect("name>1", "is a text");
  expect("quality=good", "pass, warn or fail");
  expect("quality~pass", "pass, warn or fail");
  expect("duplicate=maybe", "is yes or no");
  expect("event~left", "has no parts");
  expect("has(hand_right above hed)", "perhaps you mean \"hand_right above head\"");
  expect("has(qqqqqqqqqqqqqqqqqqqqqqqq)", "the nearest of");
  expect("text(\" \")", "the words are missing");
  expect("figure.nonsense>1", "is no figure");
}

TEST_F(QueryClips, RemarksOnValuesThatNoClipHas) {
  const auto query = run_clip_query(library_.path(), "content=wlak or subject=nobody");
  ASSERT_TRUE(query) << query.error().message();
  EXPECT_TRUE(query->numbers.empty());
  ASSERT_EQ(query->remarks.size(), 2u);
  EXPECT_NE(query->remarks[0].find("perhaps you mean \"content:walk\""),
            std::string::npos)
      << query->remarks[0];
  EXPECT_TRUE(run_clip_query(library_.path(), "content=walk")->remarks.empty());
  const auto relation = run_clip_query(library_.path(), "has(lying)");
  ASSERT_TRUE(relation) << relation.error().message();
  EXPECT_TRUE(relation->numbers.empty());
  EXPECT_EQ(relation->remarks, std::vector<std::string>{"\"lying\" holds in no clip"});
}

TEST_F(QueryClips, NeverRunsAValue) {
  for (const char* value :
       {"\"' OR 1=1 --\"", "\"\\\"; DROP TABLE clip; --\"", "%", "*"}) {
    for (const char* word :
         {"content=", "label=", "label~", "name=", "licence=", "id="}) {
      const auto found = query_clips(library_.path(), std::string(word) + value);
      ASSERT_TRUE(found) << word << value << ": " << found.error().message();
      const bool is_part = std::string_view(word) == "label~";
      EXPECT_TRUE(is_part || found->empty()) << word << value;
    }
    EXPECT_TRUE(query_clips(library_.path(), std::string("text(") + value + ")"));
  }
  EXPECT_EQ(query_clips(library_.path(), "")->size(), records_.size());
}

TEST(QueryClipsOf, NoLibraryIsAnErrorWithTheCommandThatMakesIt) {
  const testing::ScratchFolder folder;
  const auto found = query_clips(folder.path(), "");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message().find("marey library build " + folder.path().string()),
            std::string::npos)
      << found.error().message();
  ASSERT_TRUE(recordings::write_file(folder / "library.sqlite", "no database"));
  EXPECT_FALSE(query_clips(folder.path(), ""));
}

}  // namespace
}  // namespace marey::app
