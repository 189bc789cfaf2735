// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/licence_terms.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey::library {
namespace {

LicenceBar bar(const std::string& licence,
               bool is_changed,
               std::vector<std::string> allowed = {},
               bool allows_unknown = false) {
  return decide_licence(licence, is_changed, {std::move(allowed), allows_unknown}).bar;
}

TEST(LicenceTerms, AreThoseOfCreativeCommons) {
  const auto by = terms_of_licence("CC-BY-4.0");
  ASSERT_TRUE(by);
  EXPECT_TRUE(by->allows_commercial_use && by->allows_changes && by->needs_attribution);
  const auto nc_sa = terms_of_licence("cc-by-nc-sa-3.0-DE");
  ASSERT_TRUE(nc_sa);
  EXPECT_FALSE(nc_sa->allows_commercial_use);
  EXPECT_TRUE(nc_sa->allows_changes && nc_sa->needs_same_licence);
  const auto nc_nd = terms_of_licence("CC-BY-NC-ND-4.0");
  ASSERT_TRUE(nc_nd);
  EXPECT_FALSE(nc_nd->allows_commercial_use || nc_nd->allows_changes);
  const auto nd_nc = terms_of_licence("CC-BY-ND-NC-1.0");
  ASSERT_TRUE(nd_nc);
  EXPECT_FALSE(nd_nc->allows_commercial_use || nd_nc->allows_changes);
  ASSERT_TRUE(terms_of_licence("CC0-1.0"));
  EXPECT_FALSE(terms_of_licence("CC0-1.0")->needs_attribution);
  EXPECT_TRUE(terms_of_licence("GPL-2.0-only WITH Classpath-exception-2.0"));
  for (const char* other : {"CC-BY", "CC-BY-NC", "CC-BY-XX-4.0", "LicenseRef-mine", ""}) {
    EXPECT_FALSE(terms_of_licence(other)) << other;
  }
}

TEST(LicenceTerms, ReadsExpressions) {
  using Alternatives = LicenceAlternatives;
  EXPECT_EQ(*parse_licence("MIT"), (Alternatives{{"MIT"}}));
  EXPECT_EQ(*parse_licence("MIT OR A AND B"), (Alternatives{{"MIT"}, {"A", "B"}}));
  EXPECT_EQ(*parse_licence("(MIT or A) and (B OR MIT)"),
            (Alternatives{{"MIT", "B"}, {"MIT"}, {"A", "B"}, {"A", "MIT"}}));
  EXPECT_EQ(*parse_licence("GPL-2.0+ WITH x-1.0 OR ISC"),
            (Alternatives{{"GPL-2.0+ WITH x-1.0"}, {"ISC"}}));
  for (const char* bad : {"",
                          "MIT OR",
                          "AND MIT",
                          "(MIT",
                          "MIT)",
                          "MIT ISC",
                          "()",
                          "free for research",
                          "a/b.txt"}) {
    EXPECT_FALSE(parse_licence(bad)) << bad;
  }
  EXPECT_FALSE(parse_licence(std::string(100000, '('))) << "no deep recursion";
  std::string product = "(a OR b)";
  for (int i = 0; i < 60; ++i) product += " AND (a OR b)";
  EXPECT_FALSE(parse_licence(product)) << "2^61 alternatives";
}

TEST(LicenceTerms, RefusesWhatForbidsTheExport) {
  EXPECT_EQ(bar("CC-BY-4.0", true), LicenceBar::kNone);
  EXPECT_EQ(bar("CC-BY-NC-4.0", false), LicenceBar::kNonCommercial);
  EXPECT_EQ(bar("CC-BY-ND-4.0", true), LicenceBar::kNoDerivatives);
  EXPECT_EQ(bar("CC-BY-ND-4.0", false), LicenceBar::kNone);
  EXPECT_EQ(bar("unknown", false), LicenceBar::kUnknown);
  EXPECT_EQ(bar("", false), LicenceBar::kUnknown);
  EXPECT_EQ(bar("free for research", false), LicenceBar::kText);
  EXPECT_EQ(bar("LICENCE.txt", false), LicenceBar::kText);
  EXPECT_EQ(bar("LicenseRef-mine", false), LicenceBar::kText);
}

TEST(LicenceTerms, PermitsWhatTheUserNames) {
  EXPECT_EQ(bar("CC-BY-NC-4.0", true, {"cc-by-nc-4.0"}), LicenceBar::kNone);
  EXPECT_EQ(bar("CC-BY-NC-4.0", true, {"CC-BY-NC-3.0"}), LicenceBar::kNonCommercial);
  EXPECT_EQ(bar("CC-BY-ND-4.0", true, {"CC-BY-ND-4.0"}), LicenceBar::kNone);
  EXPECT_EQ(bar("free for research", true, {"free for research"}), LicenceBar::kNone);
  EXPECT_EQ(bar("unknown", true, {}, true), LicenceBar::kNone);
  EXPECT_EQ(bar("unknown", true, {"unknown"}), LicenceBar::kUnknown)
      << "it has an option of its own";
}

TEST(LicenceTerms, AppliesAllOfAndAndTheMildestOfOr) {
  EXPECT_EQ(bar("MIT AND CC-BY-NC-4.0", false), LicenceBar::kNonCommercial);
  EXPECT_EQ(bar("MIT AND CC-BY-NC-4.0", false, {"CC-BY-NC-4.0"}), LicenceBar::kNone);
  EXPECT_EQ(bar("CC-BY-NC-4.0 AND LicenseRef-x", false, {"CC-BY-NC-4.0"}),
            LicenceBar::kText);
  const LicenceDecision choice =
      decide_licence("CC-BY-NC-4.0 OR GPL-3.0-only OR MIT", true, {});
  EXPECT_EQ(choice.bar, LicenceBar::kNone);
  EXPECT_TRUE(choice.is_choice);
  EXPECT_EQ(choice.applied, std::vector<std::string>{"MIT"});
  const LicenceDecision allowed =
      decide_licence("unknown OR CC-BY-NC-4.0", true, {{"CC-BY-NC-4.0"}, false});
  EXPECT_EQ(allowed.bar, LicenceBar::kNone);
  EXPECT_EQ(allowed.applied, std::vector<std::string>{"CC-BY-NC-4.0"});
  EXPECT_FALSE(allowed.terms.allows_commercial_use);
}

}  // namespace
}  // namespace marey::library
