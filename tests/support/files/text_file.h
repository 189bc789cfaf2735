// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

namespace marey::testing {

/// Returns the bytes of a file; empty if it cannot be read.
[[nodiscard]] inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Replaces the first `from` of a text. Throws std::invalid_argument if there is none.
[[nodiscard]] inline std::string replace_first(std::string_view text,
                                               std::string_view from,
                                               std::string_view to) {
  std::string out(text);
  const std::size_t at = out.find(from);
  if (at == std::string::npos) {
    throw std::invalid_argument("the text does not contain \"" + std::string(from) +
                                "\"");
  }
  return out.replace(at, from.size(), to);
}

}  // namespace marey::testing
