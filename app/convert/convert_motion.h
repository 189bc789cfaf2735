// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/convert/convert_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// Whether a file can hold the motion of a skeleton, by its name: .bvh, .amc, .glb,
/// .gltf, .vrm or .vrma.
[[nodiscard]] bool is_motion(const std::filesystem::path& file);

/// `marey convert IN OUT` where IN is_motion().
[[nodiscard]] Exit convert_motion(const ConvertArguments& arguments, Console& console);

}  // namespace marey::app
