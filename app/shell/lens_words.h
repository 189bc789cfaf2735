// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/camera.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Returns the word for a lens in session.toml, on the command line and in results.
[[nodiscard]] constexpr std::string_view lens_word(LensModel lens) {
  for (const auto& [word, model] : recordings::kLensWords) {
    if (model == lens) return word;
  }
  return {};
}

}  // namespace marey::app
