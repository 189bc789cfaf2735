// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace marey::recordings {

/// Returns what the content of a file that should be TOML is instead, for a message: "a
/// glTF file", "a video". Looks at the first bytes alone; empty if they may be TOML.
[[nodiscard]] std::string_view other_kind(std::string_view content);

}  // namespace marey::recordings
