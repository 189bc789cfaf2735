// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey {

/// Accuracy of one camera's calibration. Zeros if it is not known.
struct CameraQuality {
  double rms_px = 0.0;          ///< RMS distance of corners to their model.
  double p95_px = 0.0;          ///< 95th percentile of that distance.
  double centre_sigma_m = 0.0;  ///< Standard deviation of its position, per coordinate.
  double focal_sigma_px = 0.0;
  int views = 0;    ///< Instants at which it saw the board.
  int corners = 0;  ///< Corners over all of them.
  /// Share of the image's 8 x 6 cells in which it saw a corner of the board, 0..1.
  double coverage = 0.0;
};

}  // namespace marey
