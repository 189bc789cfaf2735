// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace marey {

/// Returns the extension that determines a file's type: with its point and in lower case,
/// since cameras and other systems write ".MP4". Only ASCII letters are lowered, in every
/// locale.
[[nodiscard]] inline std::string kind_by_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace marey
