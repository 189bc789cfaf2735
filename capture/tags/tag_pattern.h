// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/tag_pattern.h"

namespace marey::capture {

/// Returns the shape of the family `name`, one of TagDetectorOptions::families. Errors
/// (kBadInput): it is not known.
[[nodiscard]] Result<TagFamilyShape> tag_family_shape(std::string_view name);

/// Returns the tags `ids` of the family `name`, in their order, as they must be printed
/// for TagDetector. Errors (kBadInput): the family is not known, or lacks an id.
[[nodiscard]] Result<std::vector<TagPattern>> tag_patterns(std::string_view name,
                                                           std::span<const TagId> ids);

/// Returns the first `count` markers of one of OpenCV's dictionaries, such as
/// "DICT_5X5_100" or "DICT_APRILTAG_36h11", without quiet zone. Errors (kBadInput): the
/// dictionary is not known, or has fewer. Precondition: count >= 0.
[[nodiscard]] Result<std::vector<TagPattern>> aruco_patterns(std::string_view dictionary,
                                                             int count);

}  // namespace marey::capture
