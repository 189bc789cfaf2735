// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace marey::app {

/// Returns "a, b or c" for a range of texts.
template <class Words>
[[nodiscard]] std::string or_list(const Words& words) {
  std::string list;
  std::size_t left = words.size();
  for (const auto& word : words) {
    if (!list.empty()) list += left == 1 ? " or " : ", ";
    list += word;
    --left;
  }
  return list;
}

/// Returns "1 clip" or "2 clips" for `one` = "clip".
[[nodiscard]] inline std::string counted(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace marey::app
