// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings {

/// Converts a word of an untyped file: to a number or a boolean if it has that form, else
/// to text.
[[nodiscard]] TomlValue value_of_word(std::string_view word, int line);

/// Parses YAML, OpenCV's dialect too, into the tree that TomlReader reads: maps become
/// tables, lists arrays; tags such as !!opencv-matrix are ignored.
///
/// Errors (kBadInput), with the line: not YAML; no map at the top; lists or references
/// nested without end.
[[nodiscard]] Result<TomlDocument> parse_yaml(std::string_view text,
                                              const std::string& file);

}  // namespace marey::recordings
