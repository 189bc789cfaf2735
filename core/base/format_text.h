// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include "core/base/assert.h"

namespace marey {

/// Returns the text that printf() writes for `format` and `values`, of any length.
/// Precondition: the values have the types that `format` names.
template <class... Values>
[[nodiscard]] std::string format_text(const char* format, Values... values) {
  const int length = std::snprintf(nullptr, 0, format, values...);
  MAREY_ASSERT(length >= 0);
  std::string text(static_cast<std::size_t>(length), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace marey
