// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "core/character.h"

namespace marey::app {

/// The character of a character.toml: its body read or made from a stature, its masses
/// and limits by retarget::make_character(). Without a mass of its own it has its
/// subject's.
/// Errors: as of read_character_spec(), read_skeleton() and read_subject(), map_body()
/// (naming the body's file) and make_character() (naming the character's).
[[nodiscard]] Result<Character> load_character(const std::filesystem::path& path);

}  // namespace marey::app
