// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace marey {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
};

/// Returns the first character of `text`; nullopt if its bytes are not UTF-8 (RFC 3629):
/// an overlong form, a surrogate, cut short. Precondition: `text` not empty.
[[nodiscard]] inline std::optional<Utf8Character> first_utf8(std::string_view text) {
  // Lowest code point of each length, which excludes overlong forms.
  constexpr std::array<std::uint32_t, 4> kLowest{0, 0x80, 0x800, 0x10000};
  const auto head = static_cast<unsigned char>(text[0]);
  std::size_t more = 0;
  if (head >= 0xf0 && head < 0xf8) more = 3;
  if (head >= 0xe0 && head < 0xf0) more = 2;
  if (head >= 0xc0 && head < 0xe0) more = 1;
  if ((more == 0 && head >= 0x80) || more >= text.size()) return std::nullopt;
  std::uint32_t code = more == 0 ? head : head & (0x3fU >> more);
  for (std::size_t k = 1; k <= more; ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if ((byte & 0xc0U) != 0x80) return std::nullopt;
    code = code << 6 | (byte & 0x3fU);
  }
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLowest[more] || code > 0x10ffff || is_surrogate) return std::nullopt;
  return Utf8Character{code, more + 1};
}

}  // namespace marey
