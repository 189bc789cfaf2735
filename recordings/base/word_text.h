// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/in_quotes.h"
#include "recordings/base/number_text.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {

/// Returns the first 40 characters of `word` in quotes, for messages: a broken file may
/// contain very long words.
[[nodiscard]] inline std::string quoted_start(std::string_view word) {
  return in_quotes(word.substr(0, 40));
}

/// Returns `text` with `number` appended.
[[nodiscard]] inline std::string with_number(std::string text, int number) {
  append_exact(text, number);
  return text;
}

}  // namespace marey::recordings
