// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/character.h"

namespace marey::app {

/// Loads the character of a character.toml. Its body is read or made from a stature; its
/// masses and limits are retarget::make_character()'s. If the file gives no mass, the
/// subject's mass is used.
/// Errors: those of read_character_spec(), of read_skeleton(), read_subject() and
/// map_body() (with the body's file), and of make_character() (with the character's
/// file).
[[nodiscard]] Result<Character> load_character(const std::filesystem::path& path);

}  // namespace marey::app
