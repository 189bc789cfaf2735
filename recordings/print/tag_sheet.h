// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/humanoid.h"
#include "core/tag_pattern.h"
#include "recordings/print/printed_page.h"

namespace marey::recordings {

/// A tag, with its segment.
struct TagToPrint {
  TagId id{};
  std::optional<HumanBone> segment;  ///< The segment that it will be glued to, if known.
  double size_m = 0.0;               ///< Edge of the square whose corners are detected.
  TagFamilyShape family;
  TagPattern pattern;  ///< One pattern of this family.
};

/// Tags to lay out on pages of one paper.
struct TagSheet {
  std::vector<TagToPrint> tags;
  Paper paper;
  /// Print pairs of tags as strips that fold into a roof: its faces are at 45 degrees to
  /// the limb below, 90 to each other. A pair has one size and family; its tags are
  /// neighbours in `tags`, and on the same upper or lower arm or leg. Tags without a
  /// segment are paired in their order. Remaining tags are printed flat.
  bool plates = false;
};

}  // namespace marey::recordings
