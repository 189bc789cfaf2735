// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::live {

/// Returns 128 bits from the kernel's generator as 32 hexadecimal digits. The token
/// grants access. Error (kInternal): the kernel returns no random numbers.
[[nodiscard]] Result<std::string> make_access_token();

/// Returns true if two texts are equal. The time does not depend on the content of
/// `given`, so the token cannot be found digit by digit; only its length is observable.
[[nodiscard]] bool same_token(std::string_view given, std::string_view token);

}  // namespace marey::live
