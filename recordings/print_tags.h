// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/humanoid.h"
#include "core/ids.h"
#include "core/result.h"
#include "core/tag_pattern.h"
#include "recordings/printed_page.h"

namespace marey::recordings {

struct TagToPrint {
  TagId id{};
  std::optional<HumanBone> segment;  ///< What it is to be glued to, when that is known.
  double size_m = 0.0;               ///< Edge of the square whose corners count.
  TagFamilyShape family;
  TagPattern pattern;  ///< Of this family.
};

struct TagSheet {
  std::vector<TagToPrint> tags;
  Paper paper;
  /// Print pairs of tags as strips that fold to a roof: its faces are at 45 degrees to
  /// the limb below, 90 to each other. Pairs are of one size and family, neighbours in
  /// `tags`, and of the same upper or lower arm or leg; tags whose segment is not known
  /// are paired as they come. Tags left over are printed flat.
  bool plates = false;
};

/// Lays the tags of a sheet out on pages, upright or lying, whichever needs fewer: each
/// with its quiet zone, its name, a line that shows its size, and marks to cut along.
/// Errors (kBadInput): the paper is too small for the ruler, or for one of the pieces.
/// Preconditions: at least one tag; sizes are positive.
[[nodiscard]] Result<PrintedDocument> lay_out_tags(const TagSheet& sheet);

}  // namespace marey::recordings
