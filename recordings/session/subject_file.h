// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/body.h"

namespace marey::recordings {

/// Returns the text of subject.toml (docs/formats/subject.md): every joint centre in its
/// parent's frame, tips, and the positions of tags and markers, each with its standard
/// deviation; the warnings about the body. parse_subject() returns the same doubles.
/// Precondition: every number is finite.
[[nodiscard]] std::string subject_text(const Body& body);

/// Writes subject_text() to `path`, as a whole or not at all.
[[nodiscard]] Status write_subject(const std::filesystem::path& path, const Body& body);

/// Reads a subject.toml. `file` is the name of the text in error messages. Errors
/// (kBadInput), with the line: not TOML; a key unknown, missing, of the wrong type or out
/// of range; a length that differs from its offset's length; an unknown segment; a tag or
/// a marker twice; a marker without a label.
[[nodiscard]] Result<Body> parse_subject(std::string_view text, const std::string& file);

/// Applies parse_subject() to the file at `path`.
[[nodiscard]] Result<Body> read_subject(const std::filesystem::path& path);

}  // namespace marey::recordings
