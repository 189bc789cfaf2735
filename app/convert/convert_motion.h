// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/convert/convert_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// Returns true if a file can contain the motion of a skeleton, by its extension: .bvh,
/// .amc, .npz, .glb, .gltf, .vrm or .vrma.
[[nodiscard]] bool is_motion(const std::filesystem::path& file);

/// Runs `marey convert IN OUT` for an IN that is_motion().
[[nodiscard]] Exit convert_motion(const ConvertArguments& arguments, Console& console);

}  // namespace marey::app
