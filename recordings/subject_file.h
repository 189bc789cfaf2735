// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/body.h"
#include "core/result.h"

namespace marey::recordings {

/// The text of subject.toml (docs/formats.md): every joint centre in its parent's frame,
/// tips, and where tags and markers sit, each with its standard deviation; reasons not to
/// trust it.
/// parse_subject() gives the same doubles. Precondition: every number finite.
[[nodiscard]] std::string subject_text(const Body& body);

/// Writes subject_text() to `path`, at once or not at all.
[[nodiscard]] Status write_subject(const std::filesystem::path& path, const Body& body);

/// Reads a subject.toml. `file` is what error messages call the text.
/// Errors (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type
/// or out of range; a length that is not its offset's; an unknown segment; a tag or a
/// marker twice; a marker without a label.
[[nodiscard]] Result<Body> parse_subject(std::string_view text, const std::string& file);

/// parse_subject() of the file at `path`.
[[nodiscard]] Result<Body> read_subject(const std::filesystem::path& path);

}  // namespace marey::recordings
