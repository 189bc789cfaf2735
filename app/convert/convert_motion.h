// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/convert/convert_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// Runs `marey convert INPUT OUTPUT` for an INPUT that is_body_file().
[[nodiscard]] Exit convert_motion(const ConvertArguments& arguments, Console& console);

}  // namespace marey::app
