// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "core/library/clip_record.h"

// Private to recordings/library.
namespace marey::recordings {

/// Returns the value of an enumeration of three, Verdict or RateBasis, whose name() is
/// `word`.
template <class Enum>
[[nodiscard]] std::optional<Enum> enum_named(std::string_view word) {
  for (int i = 0; i < 3; ++i) {
    if (name(static_cast<Enum>(i)) == word) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace marey::recordings
