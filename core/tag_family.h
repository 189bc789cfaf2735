// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/ids.h"

namespace marey {

/// A family of printed tags, and which of it are in use.
struct TagFamilyUse {
  std::string name = "tag36h11";  ///< As libapriltag calls it.
  std::vector<TagId> ids;         ///< Empty: any.
};

}  // namespace marey
