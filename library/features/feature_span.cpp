// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/feature_span.h"

#include <algorithm>
#include <cmath>

#include "library/features/body_features.h"

#include "core/base/assert.h"

namespace marey::library {

FeatureSpan feature_span(int first_frame, int last_frame, double rate_hz) {
  MAREY_ASSERT(first_frame <= last_frame && rate_hz > 0.0);
  // The tolerance of resample(), in instants.
  constexpr double kSame = 1e-6;
  const double instants_per_frame = kFeatureRate_hz / rate_hz;
  const double same = kSame * std::max(1.0, instants_per_frame);
  const double from = std::ceil(first_frame * instants_per_frame - same);
  const double to = std::floor(last_frame * instants_per_frame + same);
  FeatureSpan out;
  out.first_instant = static_cast<int>(from);
  out.count = std::max(1, static_cast<int>(to - from) + 1);
  if (to >= from) {
    out.start_s = std::max(0.0, from / kFeatureRate_hz - first_frame / rate_hz);
  }
  return out;
}

std::span<const float> rows_of_part(std::span<const float> rows,
                                    const FeatureSpan& whole,
                                    const FeatureSpan& part) {
  MAREY_ASSERT(rows.size() == static_cast<std::size_t>(whole.count) * kFeatureStride);
  const int count = std::min(part.count, whole.count);
  const int first =
      std::clamp(part.first_instant - whole.first_instant, 0, whole.count - count);
  return rows.subspan(static_cast<std::size_t>(first) * kFeatureStride,
                      static_cast<std::size_t>(count) * kFeatureStride);
}

}  // namespace marey::library
