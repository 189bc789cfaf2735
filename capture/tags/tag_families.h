// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <apriltag/apriltag.h>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/tag_pattern.h"

// Private to capture.
namespace marey::capture {

/// One of libapriltag's families and its constructor.
struct FamilyMaker {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

/// Returns the family, or nullptr if the name is not known.
[[nodiscard]] const FamilyMaker* find_family(std::string_view name);

/// Returns the error for an unknown family.
[[nodiscard]] Error unknown_family(std::string_view name);

/// Returns the pattern as printed. Cells outside the family's tags, such as the corners
/// of a round one, are white. Precondition: the family has this id.
[[nodiscard]] TagPattern pattern_of(apriltag_family_t* family, TagId id);

}  // namespace marey::capture
