// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/printable.h"

namespace marey {

/// Returns `word` in quotation marks, for a message, made printable(): a file of another
/// kind has any bytes. A broken file may contain words of megabytes: after 200 bytes,
/// which no path exceeds, it is cut at a whole character of UTF-8.
[[nodiscard]] inline std::string in_quotes(std::string_view word) {
  constexpr std::size_t kMaxBytes = 200;
  if (word.size() <= kMaxBytes) {
    return std::string("\"").append(printable(word)).append("\"");
  }
  std::size_t end = kMaxBytes;
  while (end > 0 && (static_cast<unsigned char>(word[end]) & 0xc0U) == 0x80) --end;
  return std::string("\"").append(printable(word.substr(0, end))).append("...\"");
}

}  // namespace marey
