// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey {

/// What somebody says a marker's label means.
struct MarkerMapEntry {
  std::string label;
  /// A landmark's name or a bone's in VRM's words; empty: the marker is not to be used.
  std::string name;
  int line = 1;  ///< Of the file.
};

/// Labels and what they mean, in the order of the file; labels differ.
struct MarkerMap {
  std::string file;  ///< What error messages call it.
  std::vector<MarkerMapEntry> entries;
};

}  // namespace marey
