// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace marey {

/// Finds the jumps of all BVH and AMC files below a folder, and prints their number by
/// content, the jumps that independent evidence contradicts, and the clips without a jump
/// whose names promise one.
void measure_library(const std::filesystem::path& folder);

}  // namespace marey
