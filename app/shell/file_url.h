// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace marey::app {

/// Returns the URL of a file for a browser (RFC 8089): the absolute path, with all bytes
/// in percent form that a URL does not have as they are (RFC 3986), as blanks.
[[nodiscard]] inline std::string file_url(const std::filesystem::path& file) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::error_code ignored;
  std::string url = "file://";
  for (const char c : std::filesystem::absolute(file, ignored).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (kPlain.find(c) != std::string_view::npos) {
      url += c;
    } else {
      url += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return url;
}

}  // namespace marey::app
