// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <apriltag/apriltag.h>

#include "core/ids.h"
#include "core/result.h"
#include "core/tag_pattern.h"

// Private to capture/.
namespace marey::capture {

/// A family of libapriltag's, and how it is made.
struct FamilyMaker {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

/// nullptr when there is none of this name.
[[nodiscard]] const FamilyMaker* find_family(std::string_view name);

/// What to say then.
[[nodiscard]] Error unknown_family(std::string_view name);

/// As printed. Cells that belong to no tag of the family, such as the corners of a round
/// one, are white. Precondition: the family has this id.
[[nodiscard]] TagPattern pattern_of(apriltag_family_t* family, TagId id);

}  // namespace marey::capture
