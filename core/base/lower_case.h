// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey {

/// Returns the letters A to Z in lower case, all other characters as they are, in any
/// locale.
[[nodiscard]] constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Returns true for A to Z and a to z, in any locale.
[[nodiscard]] constexpr bool is_ascii_letter(char c) {
  return lower_case(c) >= 'a' && lower_case(c) <= 'z';
}

/// Returns true for 0 to 9, in any locale.
[[nodiscard]] constexpr bool is_ascii_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns `text` in lower case. Bytes that are not A to Z stay as they are.
[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = lower_case(c);
  return out;
}

}  // namespace marey
