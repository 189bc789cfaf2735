// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/constraint.h"

namespace marey::recordings {

/// The constraints of a motion, in the XML of Kulpa (2005, annex A).
/// docs/formats/constraints.md lists the elements.
struct ConstraintFile {
  ConstraintSet set;
  /// Anomalies of the file, with their lines: unknown elements, which are kept in
  /// `unknown_xml`, and unknown attributes, which are not kept.
  std::vector<std::string> notes;
};

/// Parses the text of a constraint file. `file` is its name in messages.
///
/// Coordinates are marey's, in metres; with up="Z" on the root element they are converted
/// from a world with Z up: (x, z, -y). S4DMaker's segment names become VRM's. Omitted
/// values have the defaults of core/constraint.h. Linear in the text.
///
/// Errors (kBadInput), with the line: no XML, incomplete, not UTF-8, more than 16 MiB;
/// another root element; a name, body point or goal that is missing or repeated; two
/// constraints of one name; a number that is invalid or out of range. check_constraints()
/// of retarget detects constraints that a character cannot satisfy, and contradictions.
[[nodiscard]] Result<ConstraintFile> parse_constraints(std::string_view text,
                                                       const std::string& file);
/// Reads the file at `path` with parse_constraints(). Additional error: it cannot be
/// read.
[[nodiscard]] Result<ConstraintFile> read_constraints(const std::filesystem::path& path);

/// Returns a text from which parse_constraints() returns the same set: numbers exact,
/// unit quaternions, segments by VRM's names; unknown elements after the known ones. The
/// output is a fixed point: parsing and writing it again gives the same bytes.
///
/// Errors (kBadInput), with the constraint's name: the set could not be read back,
/// because its numbers are not finite, its names are empty or not one line of text, or
/// its `unknown_xml` entries are not one element each.
[[nodiscard]] Result<std::string> constraints_text(const ConstraintSet& set);
/// Writes constraints_text() to `path`, as a whole or not at all. Errors: also those of
/// write_file().
[[nodiscard]] Status write_constraints(const std::filesystem::path& path,
                                       const ConstraintSet& set);

}  // namespace marey::recordings
