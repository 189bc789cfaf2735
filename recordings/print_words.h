// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/humanoid.h"
#include "core/ids.h"
#include "core/result.h"
#include "recordings/printed_page.h"

// What a user writes about things to print. Errors (kBadInput) are for the command line.
namespace marey::recordings {

/// "80mm", "8 cm" or "3.15in", in metres. Errors: there is no unit, or it is another; no
/// number; not more than nothing, or more than 10 m.
[[nodiscard]] Result<double> parse_length_m(std::string_view text);

/// "A4", "A3", "Letter", in any case, or "210x297mm". Errors: it is something else; an
/// edge above 5 m.
[[nodiscard]] Result<Paper> parse_paper(std::string_view text);

/// A tag that was asked for, and what it is to be glued to.
struct NamedTag {
  TagId id{};
  std::optional<HumanBone> segment;
};

/// "40-75,90" or "41:hips,73:head", or both: in the order as written. Errors: no ids; an
/// id twice; a range that goes down; an unknown segment.
[[nodiscard]] Result<std::vector<NamedTag>> parse_tags(std::string_view text);

}  // namespace marey::recordings
