// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/mirrored_label.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace marey::library {
namespace {

using Pair = std::pair<const char*, const char*>;

TEST(MirroredLabel, ExchangesAllSides) {
  for (const auto& [label, other] :
       {Pair{"left", "right"},
        Pair{"walk-turn-left", "walk-turn-right"},
        Pair{"from left to right", "from right to left"},
        Pair{"turning_left", "turning_right"},
        Pair{"LeftFoot.strike", "RightFoot.strike"},
        Pair{"LEFT hand", "RIGHT hand"},
        Pair{"leftHand", "rightHand"},
        Pair{"lefthanded", "righthanded"},
        Pair{"content:raise-left-hand", "content:raise-right-hand"},
        Pair{"clockwise", "counterclockwise"},
        Pair{"Rightward 2", "Leftward 2"}}) {
    const MirroredLabel mirrored = mirrored_label(label);
    EXPECT_EQ(mirrored.text, other);
    EXPECT_TRUE(mirrored.unknown_word.empty()) << label;
    EXPECT_EQ(mirrored_label(other).text, label);
  }
  EXPECT_EQ(mirrored_label("anticlockwise").text, "clockwise");
}

TEST(MirroredLabel, KeepsLabelsWithoutSides) {
  for (const char* label : {"",
                            "walk",
                            "upright",
                            "bright side",
                            "leftover",
                            "Copyright",
                            "L",
                            "R foot",
                            "links",
                            "\xc3\xbc"}) {
    const MirroredLabel mirrored = mirrored_label(label);
    EXPECT_EQ(mirrored.text, label);
    EXPECT_TRUE(mirrored.unknown_word.empty());
  }
}

TEST(MirroredLabel, ReportsUnknownWordsAndGuessesNothing) {
  for (const auto& [label, word] : {Pair{"aleft", "aleft"},
                                    Pair{"left turnright", "turnright"},
                                    Pair{"rightish step", "rightish"}}) {
    const MirroredLabel mirrored = mirrored_label(label);
    EXPECT_EQ(mirrored.text, label);
    EXPECT_EQ(mirrored.unknown_word, word);
  }
}

}  // namespace
}  // namespace marey::library
