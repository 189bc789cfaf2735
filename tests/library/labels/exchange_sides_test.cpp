// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/labels/exchange_sides.h"

#include <string_view>
#include <utility>

#include "library/search/relations.h"
#include <gtest/gtest.h>

namespace marey::library {
namespace {

TEST(ExchangeSides, ExchangesWordsOfSides) {
  constexpr std::pair<std::string_view, std::string_view> kPairs[] = {
      {"turn left", "turn right"},
      {"wave-left-hand", "wave-right-hand"},
      {"content:raise-up-right-hand", "content:raise-up-left-hand"},
      {"left.strike", "right.strike"},
      {"hand_left touches right thigh", "hand_right touches left thigh"},
      {"LEFT foot, Right knee", "RIGHT foot, Left knee"},
      {"turnLeft", "turnRight"},
      {"kickLeftFoot2", "kickRightFoot2"},
      {"hand_l", "hand_r"},
      {"L.arm", "R.arm"},
      {"walk leftwards", "walk rightwards"},
      {"left-handed throw", "right-handed throw"},
      {"spin clockwise", "spin counterclockwise"},
      {"spin anticlockwise", "spin clockwise"},
      {"from left to right", "from right to left"}};
  for (const auto& [label, other] : kPairs) {
    EXPECT_EQ(exchanged_sides(label), other) << label;
  }
}

TEST(ExchangeSides, KeepsLabelsWithoutASide) {
  for (const std::string_view label : {"",
                                       "walk",
                                       "stand upright",
                                       "bright idea",
                                       "reads leftovers",
                                       "straight kick",
                                       "roll r",
                                       "\xc3\xa9l\xc3\xa8ve 42"}) {
    EXPECT_EQ(exchanged_sides(label), label);
  }
}

TEST(ExchangeSides, RefusesSidesThatItDoesNotUnderstand) {
  for (const std::string_view label : {"leftish turn",
                                       "turnleft",
                                       "left the room",
                                       "turns right away",
                                       "all right",
                                       "a right angle",
                                       "counter-clockwise turn",
                                       "rightturn and left"}) {
    EXPECT_FALSE(exchanged_sides(label)) << label;
  }
}

TEST(ExchangeSides, AgreesWithRelations) {
  for (int k = 0; k < kRelationCount; ++k) {
    const auto relation = static_cast<Relation>(k);
    EXPECT_EQ(exchanged_sides(name(relation)), name(mirrored(relation)));
  }
}

TEST(ExchangeSides, IsItsOwnInverse) {
  for (const std::string_view label : {"turn left",
                                       "LeftHand and rightFoot",
                                       "hand_l to hand_r",
                                       "lefty",
                                       "clockwise"}) {
    EXPECT_EQ(exchanged_sides(*exchanged_sides(label)), label);
  }
}

}  // namespace
}  // namespace marey::library
