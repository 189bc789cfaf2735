// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/web_content.h"

namespace marey::live {

bool is_web_path(std::string_view path) {
  constexpr std::size_t kMaxPathLength = 200;
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/";
  return !path.empty() && path.front() == '/' && path.size() <= kMaxPathLength &&
         path.find("..") == std::string_view::npos &&
         path.find_first_not_of(kAllowed) == std::string_view::npos;
}

}  // namespace marey::live
