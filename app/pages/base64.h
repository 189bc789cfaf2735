// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey::app {

/// Encodes `bytes` in base64 with padding, as data URLs require (RFC 4648, section 4).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace marey::app
