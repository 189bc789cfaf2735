// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "recordings/toml_reader.h"

namespace marey::recordings {

/// A word of a file whose values have no types: a number or a truth when it reads as one,
/// else text.
[[nodiscard]] TomlValue value_of_word(std::string_view word, int line);

/// Parses YAML, OpenCV's dialect too, into the tree that TomlReader reads: maps become
/// tables, lists arrays, and tags such as !!opencv-matrix are passed over.
///
/// Errors (kBadInput), with the line: not YAML; no map at the top; lists in lists in
/// lists, or references, without end.
[[nodiscard]] Result<TomlDocument> parse_yaml(std::string_view text,
                                              const std::string& file);

/// The same of the XML that OpenCV's FileStorage writes. Errors: not XML, or not
/// OpenCV's, with the line.
[[nodiscard]] Result<TomlDocument> parse_opencv_xml(std::string_view text,
                                                    const std::string& file);

}  // namespace marey::recordings
