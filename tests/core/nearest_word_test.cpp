// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_word.h"

#include <array>
#include <string_view>

#include <gtest/gtest.h>

namespace marey {
namespace {

constexpr std::array<std::string_view, 3> kWords{"rows", "columns", "first_id"};

TEST(Suggestion, NamesAWordOneLetterAway) {
  EXPECT_EQ(suggestion("column", kWords), "perhaps you mean \"columns\"");
}

TEST(Suggestion, TakesAnotherCaseForTheSameWord) {
  EXPECT_EQ(suggestion("FIRST_ID", kWords), "perhaps you mean \"first_id\"");
}

TEST(Suggestion, ListsAllWhenNoneIsNear) {
  EXPECT_EQ(suggestion("shoe", kWords),
            "choose one of \"rows\", \"columns\", \"first_id\"");
}

TEST(Suggestion, NamesTheFirstOfEquals) {
  constexpr std::array<std::string_view, 2> kTwins{"cam0", "cam1"};
  EXPECT_EQ(suggestion("cam2", kTwins), "perhaps you mean \"cam0\"");
}

TEST(MeantWord, IsNearOrHasTheSameBeginning) {
  constexpr std::array<std::string_view, 4> kOptions{
      "out", "vmc-rest", "vmc-mtu", "json"};
  EXPECT_EQ(meant_word("outt", kOptions), "out");
  EXPECT_EQ(meant_word("vmc-restt", kOptions), "vmc-rest");
  EXPECT_EQ(meant_word("output", kOptions), "out");
  EXPECT_EQ(meant_word("vmc", kOptions), "vmc-rest");
  EXPECT_EQ(meant_word("frobnicate", kOptions), std::nullopt);
  EXPECT_EQ(meant_word("j", kOptions), std::nullopt);
  EXPECT_EQ(meant_word("vmc-target", kOptions), std::nullopt);
  EXPECT_EQ(meant_word("out", {}), std::nullopt);
}

TEST(NearestWords, AreInOrderOfNearness) {
  const auto near = nearest_words("colums", kWords, 2);
  ASSERT_EQ(near.size(), 2U);
  EXPECT_EQ(near[0], "columns");
  EXPECT_EQ(near[1], "rows");
  EXPECT_EQ(nearest_words("rows", kWords, 9).size(), kWords.size());
}

TEST(Suggestion, SuggestsTheForearmBone) {
  EXPECT_EQ(bone_suggestion("left_lower_arm"), "perhaps you mean \"leftLowerArm\"");
}

}  // namespace
}  // namespace marey
