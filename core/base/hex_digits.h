// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace marey {

/// Returns true if a text is exactly `count` lower-case hexadecimal digits, as sums and
/// ids of clips are. Such a text is safe as the name of a file.
[[nodiscard]] constexpr bool is_hex(std::string_view text, std::size_t count) {
  return text.size() == count &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace marey
