// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <opencv2/aruco.hpp>

#include "core/base/result.h"

// Private to capture.
namespace marey::capture {

/// One of OpenCV's dictionaries of markers.
struct ArucoDictionary {
  std::string_view name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME code;
};

/// Returns all dictionaries; a smaller one precedes the larger ones that contain it.
[[nodiscard]] std::span<const ArucoDictionary> aruco_dictionaries();

/// Returns the dictionary `name`, such as "DICT_5X5_100". Errors (kBadInput): it is not
/// known, or has fewer than `count` markers.
[[nodiscard]] Result<cv::Ptr<cv::aruco::Dictionary>> aruco_dictionary(
    std::string_view name, int count);

}  // namespace marey::capture
