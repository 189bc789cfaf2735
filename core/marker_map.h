// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey {

/// The user's assignment of one marker label.
struct MarkerMapEntry {
  std::string label;
  /// A landmark's name or a bone's VRM name; empty: the marker is not used.
  std::string name;
  int line = 1;  ///< Line in the file.
};

/// Labels and their assignments, in the order of the file; labels differ.
struct MarkerMap {
  std::string file;  ///< Name in error messages.
  std::vector<MarkerMapEntry> entries;
};

}  // namespace marey
