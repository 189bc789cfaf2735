// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/split_clips.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace marey::library {
namespace {

using Shares = std::vector<std::pair<std::string, double>>;

const Shares kUsual{{"train", 0.8}, {"val", 0.1}, {"test", 0.1}};

ClipRecord split_record(int number, const std::string& subject, int source) {
  ClipRecord clip;
  clip.clip_id = "clip" + std::to_string(number);
  clip.provenance.subject = subject;
  clip.provenance.source_id = "source" + std::to_string(source);
  return clip;
}

/// Clips of some subjects; a tenth without one, some duplicates and mirrored copies.
std::vector<ClipRecord> random_records(std::uint64_t seed, int count) {
  std::mt19937_64 dice(seed);
  const auto below = [&](int limit) {
    return static_cast<int>(dice() % static_cast<std::uint64_t>(limit));
  };
  std::vector<ClipRecord> out;
  for (int i = 0; i < count; ++i) {
    // The clips of a source have one subject.
    const int source = below(count / 2);
    const std::string subject =
        source % 10 == 0 ? "" : "subject" + std::to_string(source % 37);
    out.push_back(split_record(i, subject, source));
    if (i > 0 && below(50) == 0) out.back().duplicate_of = out[0].clip_id;
    if (i > 0 && below(20) == 0) {
      out.back().mirror_of = out[static_cast<std::size_t>(below(i))].clip_id;
    }
  }
  return out;
}

std::map<std::string, std::string> split_by_id(const std::vector<ClipRecord>& records,
                                               SplitBy by) {
  const auto splits = split_clips(records, kUsual, by);
  std::map<std::string, std::string> out;
  for (std::size_t i = 0; i < records.size(); ++i) out[records[i].clip_id] = splits[i];
  return out;
}

TEST(SplitClips, KeepsSubjectsSourcesDuplicatesAndMirrorsTogether) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const auto records = random_records(seed, 300);
    for (const SplitBy by : {SplitBy::kSubject, SplitBy::kClip}) {
      const auto splits = split_by_id(records, by);
      std::map<std::string, std::set<std::string>> groups;
      for (const ClipRecord& clip : records) {
        const std::string& split = splits.at(clip.clip_id);
        for (const std::string& other : {clip.duplicate_of, clip.mirror_of}) {
          if (other.empty()) continue;
          EXPECT_EQ(split, splits.at(other));
        }
        groups[clip.provenance.source_id].insert(split);
        if (!clip.provenance.subject.empty()) {
          groups[clip.provenance.subject].insert(split);
        }
      }
      if (by == SplitBy::kClip) continue;
      for (const auto& [group, names] : groups) EXPECT_EQ(names.size(), 1u) << group;
    }
  }
}

TEST(SplitClips, IsIndependentOfTheOrder) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    auto records = random_records(seed, 200);
    const auto before = split_by_id(records, SplitBy::kSubject);
    std::shuffle(records.begin(), records.end(), std::mt19937_64(seed));
    EXPECT_EQ(split_by_id(records, SplitBy::kSubject), before);
  }
}

TEST(SplitClips, MovesNoClipWhenClipsAreAdded) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    auto records = random_records(seed, 300);
    // Links between subjects join groups; that is the only reason to move a clip.
    for (ClipRecord& clip : records) {
      clip.duplicate_of.clear();
      clip.mirror_of.clear();
    }
    for (const SplitBy by : {SplitBy::kSubject, SplitBy::kClip}) {
      const auto all = split_by_id(records, by);
      const auto half = split_by_id({records.begin(), records.begin() + 150}, by);
      for (const auto& [id, split] : half) EXPECT_EQ(split, all.at(id)) << id;
    }
  }
}

TEST(SplitClips, MovesNoSubjectWhenItsDuplicatesAreAdded) {
  std::vector<ClipRecord> records;
  for (int i = 0; i < 100; ++i) records.push_back(split_record(i, std::to_string(i), i));
  const auto before = split_by_id(records, SplitBy::kSubject);
  for (int i = 0; i < 100; ++i) {
    records.push_back(split_record(1000 + i, "", 1000 + i));
    records.back().duplicate_of = "clip" + std::to_string(i);
  }
  const auto after = split_by_id(records, SplitBy::kSubject);
  for (const auto& [id, split] : before) EXPECT_EQ(split, after.at(id));
}

double share_of(const std::vector<std::string>& splits, const std::string& split) {
  return static_cast<double>(std::ranges::count(splits, split)) /
         static_cast<double>(splits.size());
}

TEST(SplitClips, GivesTheSharesOfManyGroups) {
  std::vector<ClipRecord> records;
  for (int i = 0; i < 4000; ++i) {
    records.push_back(split_record(i, "s" + std::to_string(i), i));
  }
  for (const SplitBy by : {SplitBy::kSubject, SplitBy::kClip}) {
    const auto splits = split_clips(records, kUsual, by);
    EXPECT_NEAR(share_of(splits, "train"), 0.8, 0.02);
    EXPECT_NEAR(share_of(splits, "val"), 0.1, 0.02);
  }
  const Shares empty_last{{"train", 1.0}, {"test", 0.0}};
  const auto splits = split_clips(records, empty_last, SplitBy::kSubject);
  EXPECT_EQ(std::ranges::count(splits, "train"), 4000);
}

// The hash is a part of the format: a change would move clips of published data.
TEST(SplitClips, HasAFixedHash) {
  std::vector<ClipRecord> records;
  for (int i = 0; i < 12; ++i) {
    records.push_back(split_record(i, "actor" + std::to_string(i), i));
  }
  const Shares halves{{"a", 0.5}, {"b", 0.5}};
  std::string text;
  for (const std::string& split : split_clips(records, halves, SplitBy::kSubject)) {
    text += split;
  }
  EXPECT_EQ(text, "ababaaababba");
}

}  // namespace
}  // namespace marey::library
