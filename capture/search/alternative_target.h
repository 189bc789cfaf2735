// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace marey::capture {

enum class AlternativeKind {
  kMarkers,     ///< Markers of a dictionary of OpenCV.
  kAprilGrid,   ///< Tags of a family, laid out as an AprilGrid.
  kChessboard,  ///< A board without markers.
  kExpected,    ///< The expected target, in frames that were not searched.
};

/// A target in a recording that is not the expected one.
struct AlternativeTarget {
  AlternativeKind kind = AlternativeKind::kMarkers;
  /// kMarkers: OpenCV's name of the dictionary; kAprilGrid: libapriltag's name of the
  /// family; otherwise empty.
  std::string codes;
  bool is_mirrored = false;  ///< The image or the print is mirrored.
  std::string what;    ///< "markers 0 to 9 of DICT_4X4_50 are": inserted after "but".
  std::string remedy;  ///< The key to change in session.toml, or the recording to repeat.
};

}  // namespace marey::capture
