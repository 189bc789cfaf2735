// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/sample_session.h"

#include <system_error>

namespace marey::app {

std::filesystem::path sample_session() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto installed =
      (program.parent_path() / MAREY_INSTALLED_SAMPLE).lexically_normal();
  if (!error && std::filesystem::exists(installed / "session.toml", error)) {
    return installed;
  }
  return MAREY_SAMPLE;
}

}  // namespace marey::app
