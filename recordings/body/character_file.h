// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/character_spec.h"

namespace marey::recordings {

/// Returns the text of character.toml (docs/formats/character.md): source of the lengths,
/// masses, limits in degrees, loads. parse_character_spec() returns the same doubles; for
/// angles without an exact number of degrees, the nearest. Precondition: every number is
/// finite.
[[nodiscard]] std::string character_spec_text(const CharacterSpec& spec);

/// Writes character_spec_text() to `path`, as a whole or not at all.
[[nodiscard]] Status write_character_spec(const std::filesystem::path& path,
                                          const CharacterSpec& spec);

/// Parses a character.toml. `file` is the name of the text in error messages. Paths are
/// returned as written. Errors (kBadInput), with the line: not TOML; a key unknown,
/// missing, of the wrong type or out of range; none or more than one body; an unknown
/// table; limits whose minimum is above their maximum; a load without a name or with
/// another's.
[[nodiscard]] Result<CharacterSpec> parse_character_spec(std::string_view text,
                                                         const std::string& file);

/// Applies parse_character_spec() to the file at `path`. Paths of an avatar or a subject
/// become relative to the working folder instead of the file's folder.
[[nodiscard]] Result<CharacterSpec> read_character_spec(
    const std::filesystem::path& path);

}  // namespace marey::recordings
