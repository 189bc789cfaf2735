// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/in_quotes.h"
#include "recordings/base/number_text.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {

/// Returns the first 40 bytes of `word`, cut at a whole character, in quotes, for
/// messages: a broken file may contain very long words.
[[nodiscard]] inline std::string quoted_start(std::string_view word) {
  std::size_t end = std::min<std::size_t>(word.size(), 40);
  const auto is_inside = [&] {
    return end < word.size() && (static_cast<unsigned char>(word[end]) & 0xc0U) == 0x80;
  };
  while (end > 37 && is_inside()) --end;
  return in_quotes(word.substr(0, end));
}

/// Returns `text` with `number` appended.
[[nodiscard]] inline std::string with_number(std::string text, int number) {
  append_exact(text, number);
  return text;
}

}  // namespace marey::recordings
