// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey {

/// Returns `text` with a "?" for every byte that a terminal must not receive: control
/// characters, and bytes that are not UTF-8 (RFC 3629: no overlong forms, no surrogates).
/// All messages with text from files pass through it. Linear.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace marey
