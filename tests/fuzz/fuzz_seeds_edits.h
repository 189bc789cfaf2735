// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace marey::fuzz {

/// Writes seeds of recipes, one for each operation, and of annotations into `folder`.
/// False when one cannot be written.
[[nodiscard]] bool write_edit_seeds(const std::filesystem::path& folder);

}  // namespace marey::fuzz
