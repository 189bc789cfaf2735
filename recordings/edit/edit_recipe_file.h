// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::recordings {

// Recipes of `marey edit` (NAME.edit.toml): docs/formats/edit_recipe.md lists the keys.

/// Parses a recipe. `name` is the name of the text in messages. Files that it names are
/// not opened. Angles are in degrees in the text and in radians in the recipe. Keys that
/// are absent have the defaults of core/edit/. Linear in the text.
///
/// Errors (kBadInput), with the line: not TOML, more than 16 MiB, another kind of file, a
/// newer format; a key unknown, missing, of the wrong type or out of range, or two keys
/// of one meaning; an operation or a version of one that does not exist; no source, two
/// sources of one id, a `splice` of a source that is not listed; more than 10000
/// operations; a span that ends before it starts. Applying an operation
/// checks if it suits the motion.
[[nodiscard]] Result<EditRecipe> parse_edit_recipe(std::string_view text,
                                                   const std::filesystem::path& name);

/// Applies parse_edit_recipe() to the file at `path`. Additional errors: those of
/// read_file().
[[nodiscard]] Result<EditRecipe> read_edit_recipe(const std::filesystem::path& path);

/// Parses the text of one operation: a single [[op]]. Errors: those of
/// parse_edit_recipe() for an operation; none, or several.
[[nodiscard]] Result<EditOp> parse_edit_op(std::string_view text,
                                           const std::filesystem::path& name);

/// Returns the canonical text of a recipe: the same recipe gives the same bytes, keys
/// with default values are left out, and the text of the recipe that is parsed from it is
/// the same. Numbers are read back exactly, except angles for which no number of degrees
/// does (1e-13 of the angle), and the scale of quaternions. Lines of errors and
/// Constraint::unknown_xml are not part of the text.
/// Preconditions: numbers are finite, texts UTF-8, rotations not zero.
[[nodiscard]] std::string edit_recipe_text(const EditRecipe& recipe);

/// Selects if the text of an operation contains its `why`.
enum class WhyText { kIncluded, kLeftOut };

/// Returns the canonical text of one operation, "[[op]]" and its keys. Without `why` it
/// is the same for all operations that do the same, as in a key of a cache.
/// Preconditions: those of edit_recipe_text().
[[nodiscard]] std::string edit_op_text(const EditOp& op,
                                       WhyText why = WhyText::kIncluded);

/// Writes edit_recipe_text() to `path`, as a whole or not at all.
/// Errors: (kBadInput) those of parse_edit_recipe() for the text, so that no file is
/// written that cannot be read; those of write_file().
[[nodiscard]] Status write_edit_recipe(const std::filesystem::path& path,
                                       const EditRecipe& recipe);

}  // namespace marey::recordings
