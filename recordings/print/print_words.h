// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/humanoid.h"
#include "recordings/print/printed_page.h"

// Parsers of print options. Errors (kBadInput) are worded for the command line.
namespace marey::recordings {

/// Parses "80mm", "8 cm" or "3.15in" to metres. Errors: no unit, or an unknown one; no
/// number; not above 0, or above 10 m.
[[nodiscard]] Result<double> parse_length_m(std::string_view text);

/// Parses "A4", "A3", "Letter", in any case, or "210x297mm". Errors: any other text; an
/// edge above 5 m.
[[nodiscard]] Result<Paper> parse_paper(std::string_view text);

/// A requested tag, and the segment that it will be glued to.
struct NamedTag {
  TagId id{};
  std::optional<HumanBone> segment;
};

/// Parses "40-75,90" or "41:hips,73:head", or both; the result is in the order of the
/// text. Errors: no ids; an id twice; a descending range; an unknown segment.
[[nodiscard]] Result<std::vector<NamedTag>> parse_tags(std::string_view text);

}  // namespace marey::recordings
