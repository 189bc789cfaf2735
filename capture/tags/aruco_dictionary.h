// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/tag_pattern.h"

// Private to capture.
namespace marey::capture {

/// The name of one of OpenCV's dictionaries of markers.
struct ArucoDictionary {
  std::string_view name;
  int side = 0;   ///< Cells in a row of a marker, without its black border.
  int count = 0;  ///< Ids are 0 to count - 1.
};

/// Codes of square markers with a black border of one cell.
struct MarkerCodes {
  int side = 0;  ///< Cells in a row, without the border.
  /// Cells by id: row by row, the top left one is the highest of side * side bits; 1 is
  /// white.
  std::vector<std::uint64_t> codes;
  int correctable_bits = 0;  ///< Wrong cells up to which a marker is certain enough.
};

/// Returns all dictionaries; a smaller one precedes the larger ones that contain it.
[[nodiscard]] std::span<const ArucoDictionary> aruco_dictionaries();

/// Returns the markers of the dictionary `name`, such as "DICT_5X5_100". Errors
/// (kBadInput): it is not known, or has fewer than `count` markers.
[[nodiscard]] Result<MarkerCodes> aruco_dictionary(std::string_view name, int count);

/// Returns a marker as printed, its black border included. Precondition: the id exists.
[[nodiscard]] TagPattern marker_pattern(const MarkerCodes& markers, int id);

}  // namespace marey::capture
