// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/printable.h"

#include <string>

#include <gtest/gtest.h>

#include "core/base/in_quotes.h"

namespace marey {
namespace {

TEST(Printable, KeepsTextOfAnyLanguage) {
  EXPECT_EQ(printable(""), "");
  EXPECT_EQ(printable("walk 1.bvh"), "walk 1.bvh");
  EXPECT_EQ(printable("G\xc3\xa9rard \xe6\xad\xa9 \xf0\x9f\x9a\xb6"),
            "G\xc3\xa9rard \xe6\xad\xa9 \xf0\x9f\x9a\xb6");
}

TEST(Printable, ReplacesControlCharacters) {
  EXPECT_EQ(printable("a\x1b[31mb\nc\x7f"), "a?[31mb?c?");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xc2\x9b"), "??");  // U+009B begins a sequence of a terminal.
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "fdp"),
            "???fdp");  // U+202E turns the text round.
}

TEST(Printable, ReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("glTF\x02\xff"), "glTF??");
  EXPECT_EQ(printable("\xc3"), "?");                 // Cut short.
  EXPECT_EQ(printable("\xc0\xaf"), "??");            // Overlong.
  EXPECT_EQ(printable("\xed\xa0\x80"), "???");       // A surrogate.
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????");  // Above U+10FFFF.
}

TEST(Printable, IsAppliedToWordsInQuotes) {
  EXPECT_EQ(in_quotes("a\x02\xe9"), "\"a??\"");
  EXPECT_EQ(in_quotes("h\xc3\xbc"
                      "fte"),
            "\"h\xc3\xbc"
            "fte\"");
  EXPECT_EQ(in_quotes(std::string(300, '\x01')), "\"" + std::string(200, '?') + "...\"");
}

}  // namespace
}  // namespace marey
