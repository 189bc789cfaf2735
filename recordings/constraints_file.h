// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/constraint.h"
#include "core/result.h"

namespace marey::recordings {

/// The constraints of a motion, in the XML of Kulpa (2005, annex A). docs/formats.md says
/// which elements there are.
struct ConstraintFile {
  ConstraintSet set;
  /// What was odd in the file that was read, with its line: elements that mean nothing to
  /// marey, which are kept in `unknown_xml`, and attributes, which are not kept.
  std::vector<std::string> notes;
};

/// Reads the text of a constraint file. `file` is what messages call it.
///
/// Coordinates are marey's, in metres; with up="Z" on the root they are turned from a
/// world with Z up: (x, z, -y). Names that S4DMaker gives to segments become VRM's.
/// What a file leaves out is as core/constraint.h has it. Linear in the text.
///
/// Errors (kBadInput), with the line: no XML, cut off, not UTF-8, more than 16 MiB;
/// another root; a name, body point or goal that is missing or there twice; two
/// constraints of one name; a number that is none or out of range. What a character
/// cannot do, or what contradicts itself, is retarget's to say (check_constraints()).
[[nodiscard]] Result<ConstraintFile> parse_constraints(std::string_view text,
                                                       const std::string& file);
/// The same of a file; errors also when it cannot be read.
[[nodiscard]] Result<ConstraintFile> read_constraints(const std::filesystem::path& path);

/// The text from which parse_constraints() makes the same set: numbers to the last bit,
/// quaternions unit, segments by VRM's names; elements that are not known stand after
/// those that are. The text of what was read from it is the same to the byte.
///
/// Errors (kBadInput), with the constraint's name: the set could not be read again, as
/// its numbers are not finite, its names empty or not one line of text, or its
/// `unknown_xml` not one element each.
[[nodiscard]] Result<std::string> constraints_text(const ConstraintSet& set);
/// Writes it, whole or not at all. Errors also as write_file()'s.
[[nodiscard]] Status write_constraints(const std::filesystem::path& path,
                                       const ConstraintSet& set);

}  // namespace marey::recordings
