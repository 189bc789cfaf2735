// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/hex_digits.h"

#include <string>

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(HexDigits, AreLowerCaseAndOfTheRightNumber) {
  EXPECT_TRUE(is_hex("0123456789abcdef", 16));
  EXPECT_TRUE(is_hex("", 0));
  EXPECT_FALSE(is_hex("", 16));
  EXPECT_FALSE(is_hex("0123456789abcde", 16));
  EXPECT_FALSE(is_hex("0123456789abcdef0", 16));
  EXPECT_FALSE(is_hex("0123456789abcdeF", 16));
  EXPECT_FALSE(is_hex("../3456789abcdef", 16));
  EXPECT_FALSE(is_hex(std::string(16, '\0'), 16));
}

}  // namespace
}  // namespace marey
