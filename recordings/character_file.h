// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/character_spec.h"
#include "core/result.h"

namespace marey::recordings {

/// The text of character.toml (docs/formats.md): whose lengths, masses, limits in
/// degrees, loads. parse_character_spec() gives the same doubles; of angles that no
/// number of degrees gives exactly, the nearest. Precondition: every number finite.
[[nodiscard]] std::string character_spec_text(const CharacterSpec& spec);

/// Writes character_spec_text() to `path`, at once or not at all.
[[nodiscard]] Status write_character_spec(const std::filesystem::path& path,
                                          const CharacterSpec& spec);

/// Reads a character.toml. `file` is what error messages call the text. Paths stay as
/// they are written.
/// Errors (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type
/// or out of range; none or more than one body; an unknown table; limits whose least is
/// above their most; a load without a name or with another's.
[[nodiscard]] Result<CharacterSpec> parse_character_spec(std::string_view text,
                                                         const std::string& file);

/// parse_character_spec() of the file at `path`, an avatar's or subject's path made
/// relative to where marey runs instead of to the file's folder.
[[nodiscard]] Result<CharacterSpec> read_character_spec(
    const std::filesystem::path& path);

}  // namespace marey::recordings
