// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::live {

/// 128 bits from the kernel's generator, as 32 hexadecimal digits: who has it may look.
/// Error (kInternal): the kernel gives none.
[[nodiscard]] Result<std::string> make_access_token();

/// Whether two texts agree. Takes as long whatever `given` holds, so that it cannot be
/// found digit by digit; only its length shows.
[[nodiscard]] bool same_token(std::string_view given, std::string_view token);

}  // namespace marey::live
