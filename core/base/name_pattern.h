// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace marey {

/// Returns true if the last part of `path` is a pattern for several files:
/// "stereo/left*.jpg".
[[nodiscard]] inline bool is_name_pattern(const std::filesystem::path& path) {
  return path.filename().string().find('*') != std::string::npos;
}

/// Returns true if `name` matches `pattern`: its first '*' matches any letters, or none.
/// Precondition: `pattern` has a '*'.
[[nodiscard]] inline bool fits_pattern(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  const std::string_view head = pattern.substr(0, star);
  const std::string_view tail = pattern.substr(star + 1);
  return name.size() >= head.size() + tail.size() && name.starts_with(head) &&
         name.ends_with(tail);
}

}  // namespace marey
