// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The page of a check, as text and in a browser.
#include "app/library/check/check_page.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/app/browser.h"
#include "tests/app/library/check/checked_clips.h"

namespace marey::app {
namespace {

using marey::testing::checked_clips;
using marey::testing::show_page;
using marey::testing::ShownPage;

constexpr const char* kHostileName = "</script><img src=x onerror=alert(1)><b>x";

std::string page_of(std::vector<ClipRecord> clips) {
  LibraryCheck check = check_library(std::move(clips),
                                     library::QualityLimits({}),
                                     {{kHostileName, kHostileName, kHostileName, "x"}});
  check.library = kHostileName;
  check.folder = "/data/it's here";
  return check_page(check);
}

std::vector<ClipRecord> hostile_clips() {
  std::vector<ClipRecord> clips = checked_clips(40);
  for (ClipRecord& clip : clips) {
    clip.name = kHostileName;
    clip.provenance.path = kHostileName;
    clip.figures[0].name = kHostileName;
    clip.problems = {{{1, 3}, kHostileName, kHostileName, 1.0}};
  }
  return clips;
}

TEST(CheckPage, HasTheSameBytesForTheSameClips) {
  EXPECT_EQ(page_of(checked_clips(50)), page_of(checked_clips(50)));
}

TEST(CheckPage, ContainsNoMarkupOfNames) {
  const std::string page = page_of(hostile_clips());
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("<b>x"), std::string::npos);
}

TEST(CheckPage, MayLoadNothing) {
  const std::string page = page_of(checked_clips(3));
#ifndef MAREY_PLAIN_PAGES
  EXPECT_NE(page.find("default-src 'none'; img-src data:;"), std::string::npos);
#endif
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("<link rel=\"stylesheet"), std::string::npos);
}

TEST(CheckPage, KeepsTheWorstOfMoreClipsThanItCanShow) {
  std::vector<ClipRecord> clips(kMaxPageClips + 5);
  for (std::size_t i = 0; i < clips.size(); ++i) {
    clips[i].clip_id = "c" + std::to_string(i);
    clips[i].rate_hz = 30.0;
  }
  clips.back().quality = Verdict::kFail;
  const std::string page = page_of(std::move(clips));
  EXPECT_NE(page.find("\"c10004\""), std::string::npos);
  EXPECT_EQ(page.find("\"c10003\""), std::string::npos);
#ifndef MAREY_PLAIN_PAGES
  EXPECT_NE(page.find("\"left_out\":5"), std::string::npos);
#endif
}

using CheckPageInABrowser = marey::testing::InABrowser;

TEST_F(CheckPageInABrowser, ShowsThreeThousandClips) {
  const ShownPage shown = show_page(page_of(checked_clips(3000)), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.status("clips"), "3000");
  // Further rows are made when they come into view.
  EXPECT_EQ(shown.status("rows"), "60");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
  EXPECT_NE(shown.page.find("marey view '/data/it'\\''s here'"), std::string::npos);
}

TEST_F(CheckPageInABrowser, MakesNoElementOutOfAName) {
  const ShownPage shown = show_page(page_of(hostile_clips()), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.page.find("<img"), std::string::npos);
  EXPECT_EQ(shown.page.find("<b>x"), std::string::npos);
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

TEST_F(CheckPageInABrowser, ShowsAnEmptyLibrary) {
  const ShownPage shown = show_page(page_of({}), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

}  // namespace
}  // namespace marey::app
