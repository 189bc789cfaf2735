// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "engine/clips/make_clip.h"

#include "core/base/result.h"

namespace marey {

/// Reads a gait and makes one cycle of it that loops (edit cyclify). The name "drunk"
/// doubles the sway of the trunk and searches a cycle of two strides. Errors: those of
/// the file and of the recipe.
[[nodiscard]] Result<engine::ClipSource> read_cycle(const std::filesystem::path& file,
                                                    const std::string& name);

}  // namespace marey
