// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/edit/annotation.h"

namespace marey::recordings {

/// Returns the text of an annotations file (docs/formats/edit_recipe.md): JSON from which
/// parse_annotations() returns the same annotations, numbers exact. The same annotations
/// give the same bytes.
/// Errors (kBadInput), with the note or curve: a number that is not finite, a text that
/// is empty or not one line of UTF-8, a note that ends before it starts, two curves of
/// one name, curves of different lengths.
[[nodiscard]] Result<std::string> annotations_text(const Annotations& annotations);

/// Parses an annotations file. `name` is the name of the text in messages. Notes are
/// sorted by start, then by text. Linear in the text, but for the sort.
/// Errors (kBadInput), with the line or the element: not JSON, nested too deep, more than
/// 256 MiB, a newer format; a key unknown or missing, a value of the wrong type; the
/// errors of annotations_text().
[[nodiscard]] Result<Annotations> parse_annotations(std::string_view text,
                                                    const std::filesystem::path& name);

/// Applies parse_annotations() to the file at `path`. Additional errors: read_file()'s.
[[nodiscard]] Result<Annotations> read_annotations(const std::filesystem::path& path);

/// Writes annotations_text() to `path`, as a whole or not at all. Additional errors:
/// write_file()'s.
[[nodiscard]] Status write_annotations(const std::filesystem::path& path,
                                       const Annotations& annotations);

}  // namespace marey::recordings
