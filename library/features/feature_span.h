// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace marey::library {

/// Rows of features that the frames of a clip have.
struct FeatureSpan {
  int first_instant = 0;  ///< In 0.1 s, counted like the frames of the source.
  int count = 0;          ///< At least 1.
  double start_s = 0.0;   ///< Time of the first row since the first frame.
};

/// Returns the rows of body_features() for frames `first_frame` to `last_frame` of a
/// motion: the instants k / 10 s between them, or one for the first frame if there is
/// none. Precondition: first_frame <= last_frame; the rate is positive.
[[nodiscard]] FeatureSpan feature_span(int first_frame, int last_frame, double rate_hz);

/// Returns the rows of a part of a motion, of the rows of the whole. A part without an
/// instant has the nearest row. Precondition: `rows` are those of `whole`,
/// kFeatureStride floats each; the frames of `part` are in the whole.
[[nodiscard]] std::span<const float> rows_of_part(std::span<const float> rows,
                                                  const FeatureSpan& whole,
                                                  const FeatureSpan& part);

}  // namespace marey::library
