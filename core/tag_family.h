// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ids.h"

namespace marey {

/// A family of printed tags that marey reads and prints.
struct KnownFamily {
  std::string_view name;  ///< Name in libapriltag.
  int tags = 0;           ///< Number of ids: 0 to tags - 1.
};

/// The default first. tag36h11b2 is tag36h11 in a frame of two cells, as on Kalibr's
/// boards.
inline constexpr std::array<KnownFamily, 10> kTagFamilies{{
    {"tag36h11", 587},
    {"tag36h11b2", 587},
    {"tag25h9", 35},
    {"tag16h5", 30},
    {"tag36h10", 2320},
    {"tagStandard41h12", 2115},
    {"tagCircle21h7", 38},
    {"tagCircle49h12", 65535},
    {"tagCustom48h12", 42211},
    {"tagStandard52h13", 48714},
}};

/// A family of printed tags, and the ids in use.
struct TagFamilyUse {
  std::string name = "tag36h11";  ///< Name in libapriltag.
  std::vector<TagId> ids;         ///< Empty: all.
};

}  // namespace marey
