// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/similar_clips.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/library_records.h"
#include "recordings/motion/bvh.h"
#include "tests/app/library/find/search_library.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::search_clip;
using testing::SearchClip;

/// Ten clips of 8 s. Clip 3 contains seconds 2 to 5 of clip 1 from its second 4 on; clip
/// 4 is the mirror image of clip 2. Clip 7 begins between two instants of 0.1 s.
class SimilarSearch : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int k = 0; k < 10; ++k) {
      clips_.push_back(search_clip(k, k == 7 ? 1 : 0, k == 7 ? 241 : 240));
    }
    constexpr std::ptrdiff_t kStride = library::kFeatureStride;
    std::copy_n(clips_[1].rows.begin() + 20 * kStride,
                31 * kStride,
                clips_[3].rows.begin() + 40 * kStride);
    clips_[4].rows = library::mirrored_features(clips_[2].rows);
    clips_[5].record.name = "clip 6";
    write();
  }

  void write() { testing::write_search_library(library_.path(), clips_); }

  SimilarClips find(const std::string& text, const SimilarClipsOptions& options = {}) {
    const auto search = open_search(library_.path());
    EXPECT_TRUE(search) << (search ? "" : search.error().message());
    if (!search) return {};
    const auto query = read_similar_query(library_.path(), text, *search);
    EXPECT_TRUE(query) << (query ? "" : query.error().message());
    if (!query) return {};
    const auto found = find_similar_clips(library_.path(), *query, *search, options);
    EXPECT_TRUE(found) << (found ? "" : found.error().message());
    return found ? *found : SimilarClips{};
  }

  std::string refusal(const std::string& text) {
    const auto search = open_search(library_.path());
    if (!search) return search.error().message();
    const auto query = read_similar_query(library_.path(), text, *search);
    return query ? std::string() : query.error().message();
  }

  testing::ScratchFolder library_;
  std::vector<SearchClip> clips_;
};

TEST_F(SimilarSearch, FindsTheClipsThatContainAPart) {
  const auto found = find("clip 1@2.5-4.5");
  ASSERT_EQ(found.clips.size(), 9u) << "the clip itself is left out";
  EXPECT_EQ(found.clips[0].clip.number, 3);
  EXPECT_EQ(found.clips[0].clip.name, "clip 3");
  EXPECT_NEAR(found.clips[0].start_s, 4.5, 1e-9);
  EXPECT_NEAR(found.clips[0].end_s, 6.5, 1e-9);
  EXPECT_NEAR(found.clips[0].distance, 0.0, 1e-6);
  EXPECT_GT(found.clips[1].distance, 0.5);
  EXPECT_EQ(found.clips[0].clip.labels, std::vector<std::string>{"odd"});
  SimilarClipsOptions options;
  options.exact = true;
  options.top = 3;
  const auto exact = find("clip 1@2.5-4.5", options);
  ASSERT_EQ(exact.clips.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(exact.clips[k].clip.number, found.clips[k].clip.number);
  }
}

TEST_F(SimilarSearch, FindsMirrorImages) {
  SimilarClipsOptions options;
  options.mirror = true;
  EXPECT_EQ(find("clip 2@1-3", options).clips[0].clip.number, 4);
  options.whole_clips = true;
  const auto whole = find("clip 2", options);
  EXPECT_EQ(whole.clips[0].clip.number, 4);
  EXPECT_NEAR(whole.clips[0].start_s, 0.0, 1e-9);
  EXPECT_NEAR(whole.clips[0].end_s, 8.0, 1e-9);
}

TEST_F(SimilarSearch, IsRestrictedByAnExpression) {
  SimilarClipsOptions options;
  options.query = "label=even";
  for (const bool exact : {false, true}) {
    options.exact = exact;
    const auto found = find("clip 1@2.5-4.5", options);
    ASSERT_EQ(found.clips.size(), 5u);
    for (const SimilarClip& one : found.clips) EXPECT_EQ(one.clip.number % 2, 0);
  }
  options.query = "label=evne";
  const auto none = find("clip 1", options);
  EXPECT_TRUE(none.clips.empty());
  EXPECT_EQ(none.remarks.size(), 1u);
}

// The query is shorter than a window of the scan.
TEST_F(SimilarSearch, ComparesAShortPartExactly) {
  const auto found = find("clip 1@3-3.5");
  EXPECT_EQ(found.clips[0].clip.number, 3);
  EXPECT_NEAR(found.clips[0].start_s, 5.0, 1e-9);
}

TEST_F(SimilarSearch, HasTimesSinceTheFirstFrameOfTheClip) {
  // Its first instant is 0.1 s of the source, 2 frames after its first frame.
  clips_[7].rows = clips_[1].rows;
  clips_[7].rows.resize(
      static_cast<std::size_t>(library::feature_span(1, 241, 30.0).count) *
      library::kFeatureStride);
  write();
  const auto found = find("clip 1@0-2");
  ASSERT_EQ(found.clips[0].clip.number, 7);
  EXPECT_NEAR(found.clips[0].start_s, 2.0 / 30.0, 1e-9);
  EXPECT_NEAR(found.clips[0].end_s, 2.0 + 2.0 / 30.0, 1e-9);
}

TEST_F(SimilarSearch, FindsTheMotionOfAFile) {
  const fs::path file = library_ / "walk@home.bvh";
  ASSERT_TRUE(recordings::write_bvh(file, testing::synthetic_walk(241, 30.0).motion));
  const auto search = open_search(library_.path());
  ASSERT_TRUE(search) << search.error().message();
  const auto query = read_similar_query(library_.path(), file.string(), *search);
  ASSERT_TRUE(query) << query.error().message();
  clips_[8].rows = query->rows;
  write();
  const auto found = find(file.string());
  EXPECT_EQ(found.clips[0].clip.number, 8);
  EXPECT_NEAR(found.clips[0].distance, 0.0, 1e-6);
  const auto part = find(file.string() + "@1-3");
  EXPECT_EQ(part.clips[0].clip.number, 8);
  ASSERT_TRUE(recordings::write_file(library_ / "no.bvh", "HIERARCHY nothing"));
  EXPECT_NE(refusal((library_ / "no.bvh").string()).find("no.bvh"), std::string::npos);
}

TEST_F(SimilarSearch, RefusesUnknownClipsAndParts) {
  const auto expect = [&](const std::string& text, std::string_view part) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(part), std::string::npos) << text << ": " << message;
  };
  expect("clop 1", "perhaps you mean \"clip 1\"");
  expect("clip 6", "2 clips are called so");
  expect("c1f0", "10 clips are called so");
  expect("none.bvh", "no clip of the library, and no file");
  expect("clip 1@3-2", "no part of \"clip 1\", which has 8.00 s");
  expect("clip 1@1-99", "no part of");
  expect("clip 1@-1-2", "no clip of the library");
  EXPECT_EQ(refusal("clip 1@7.9-8"), "");
  EXPECT_EQ(refusal(clips_[2].record.clip_id), "");
}

TEST_F(SimilarSearch, RefusesADamagedLibrary) {
  fs::resize_file(library_ / "search/rows/windows.f32", 100);
  EXPECT_NE(refusal("clip 1").find("windows.f32"), std::string::npos);
  write();
  auto fewer = clips_;
  fewer.pop_back();
  std::vector<ClipRecord> records;
  for (const SearchClip& clip : fewer) records.push_back(clip.record);
  recordings::IndexHead head;
  head.search = "rows";
  ASSERT_TRUE(
      recordings::write_library_index(library_ / "library.sqlite", records, head));
  EXPECT_NE(refusal("clip 1").find("another number of clips"), std::string::npos);
  fs::remove_all(library_ / "search");
  EXPECT_NE(refusal("clip 1").find("library build"), std::string::npos);
  fs::remove(library_ / "library.sqlite");
  EXPECT_NE(refusal("clip 1").find("library build"), std::string::npos);
}

TEST(DivideRange, TakesTheLastPairOfNumbers) {
  EXPECT_EQ(divide_range("walk@1.5-3").first, "walk");
  EXPECT_EQ(divide_range("walk@1.5-3").second->second, 3.0);
  EXPECT_EQ(divide_range("a@b@0-2").first, "a@b");
  for (const char* plain : {"walk",
                            "walk@",
                            "walk@1",
                            "walk@a-b",
                            "walk@1-",
                            "walk@-3",
                            "@1-2",
                            "walk@1-2s",
                            "walk@nan-2",
                            ""}) {
    EXPECT_EQ(divide_range(plain).first, plain);
    EXPECT_FALSE(divide_range(plain).second) << plain;
  }
}

}  // namespace
}  // namespace marey::app
