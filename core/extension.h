// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace marey {

/// A file's extension by which its kind is told: with its point and in lower case, since
/// cameras and other systems write ".MP4". ASCII alone is lowered, whatever the locale.
[[nodiscard]] inline std::string kind_by_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace marey
