// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "capture/tags/aruco_dictionary.h"

// Private to capture.
namespace marey::capture {

/// A detected marker.
struct ReadMarker {
  int id = 0;
  std::vector<cv::Point2f> corners_px;  ///< From its top left, clockwise when upright.
};

/// Detects the markers of a dictionary with libapriltag, as a family of its own. A marker
/// needs a white edge of half a cell around it, which it has on boards whose markers
/// are at most 0.85 times as wide as their squares. Not thread-safe.
class MarkerReader {
 public:
  /// Reserves up to some 10 MB for the codes with wrong cells.
  explicit MarkerReader(const MarkerCodes& markers);
  MarkerReader(MarkerReader&&) noexcept;
  MarkerReader& operator=(MarkerReader&&) noexcept;
  ~MarkerReader();

  /// Returns all markers in a grey image, in the order of detection.
  [[nodiscard]] std::vector<ReadMarker> read(const cv::Mat& gray);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
