// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/number_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

template <std::size_t kSize, class... Arguments>
void append(std::string& text, Arguments... arguments) {
  std::array<char, kSize> digits;  // NOLINT: filled by to_chars().
  const auto [end, problem] =
      std::to_chars(digits.data(), digits.data() + digits.size(), arguments...);
  MAREY_ASSERT(problem == std::errc{});
  text.append(digits.data(), end);
}

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
  MAREY_ASSERT(std::isfinite(value) && decimals >= 0 && decimals <= 20);
  const std::size_t at = text.size();
  // The longest double has 309 digits before the point.
  append<340>(text, value, std::chars_format::fixed, decimals);
  const bool is_zero = text.find_first_not_of("-0.", at) == std::string::npos;
  if (text[at] == '-' && is_zero) text.erase(at, 1);
}

void append_exact(std::string& text, double value) {
  append<32>(text, value);
}

void append_exact(std::string& text, int value) {
  append<16>(text, value);
}

}  // namespace marey::recordings
