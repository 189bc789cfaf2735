// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/printable.h"

#include "core/base/utf8.h"

namespace marey {

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const auto next = first_utf8(text);
    const bool is_control =
        next && (next->code < 0x20 || (next->code >= 0x7f && next->code < 0xa0));
    const std::size_t bytes = next ? next->bytes : 1;
    if (!next || is_control) {
      out.append(bytes, '?');
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return out;
}

}  // namespace marey
