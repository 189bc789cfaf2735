// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/printable.h"

#include <cstdint>

#include "core/base/utf8.h"

namespace marey {
namespace {

/// Returns true for codes that move the cursor, change the terminal or turn the direction
/// of the text.
bool is_control(std::uint32_t code) {
  const bool turns_text =
      (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || turns_text;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const auto next = first_utf8(text);
    const std::size_t bytes = next ? next->bytes : 1;
    if (!next || is_control(next->code)) {
      out.append(bytes, '?');
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return out;
}

}  // namespace marey
