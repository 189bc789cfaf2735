// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace marey {

/// Returns the word for messages: "word", quotes included. A word above 200 bytes is cut
/// at a character of UTF-8 and ends with "...", since a broken file may contain words of
/// megabytes; a path is shorter.
[[nodiscard]] inline std::string in_quotes(std::string_view word) {
  constexpr std::size_t kMaxBytes = 200;
  if (word.size() <= kMaxBytes) return std::string("\"").append(word).append("\"");
  std::size_t end = kMaxBytes;
  while (end > 0 && (static_cast<unsigned char>(word[end]) & 0xc0U) == 0x80) --end;
  return std::string("\"").append(word.substr(0, end)).append("...\"");
}

}  // namespace marey
