// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/lower_case.h"

namespace marey {

/// Returns the extension that determines a file's type: with its point and in lower case,
/// since cameras and other systems write ".MP4". Only ASCII letters are lowered, in every
/// locale.
[[nodiscard]] inline std::string kind_by_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) {
    c = lower_case(c);
  }
  return text;
}

}  // namespace marey
