// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/assert.h"
#include "core/base/time.h"
#include "core/source.h"

namespace marey {

/// Position of a marker at one instant.
struct MarkerSample {
  glm::dvec3 p_in_world{0.0};  ///< [m]
  /// Standard deviation per coordinate; for samples from files the residual, which is the
  /// distance of the cameras' rays from the point. 0 if it is not known.
  float sigma_m = 0.0F;
  /// Bit i: camera i + 1 saw it. Files have room for seven cameras; 0 if the file does
  /// not state it.
  std::uint8_t cameras = 0;
  Source source = Source::kMeasured;
};

/// Labelled markers over time, at a constant rate, in the world: Y up, metres. A marker
/// that was not seen has no sample. Stored frame by frame, each frame's markers in the
/// order of their labels: access to whole bodies is sequential, access to one marker has
/// a stride of markers().
///
/// Invariant: samples.size() is a multiple of labels.size(), and empty without labels.
struct MarkerTracks {
  std::vector<std::string> labels;  ///< All different, none empty.
  FrameRate rate;
  int first_frame = 1;   ///< Number of the first frame in the recording.
  double start_s = 0.0;  ///< Time of the first frame on the recording's clock.
  std::vector<std::optional<MarkerSample>> samples;

  [[nodiscard]] std::size_t markers() const { return labels.size(); }
  [[nodiscard]] std::size_t frames() const {
    return labels.empty() ? 0 : samples.size() / labels.size();
  }
  /// Precondition: frame < frames(), marker < markers().
  [[nodiscard]] const std::optional<MarkerSample>& at(std::size_t frame,
                                                      std::size_t marker) const {
    MAREY_ASSERT(marker < labels.size());
    MAREY_ASSERT(frame * labels.size() + marker < samples.size());
    return samples[frame * labels.size() + marker];
  }
  [[nodiscard]] std::optional<MarkerSample>& at(std::size_t frame, std::size_t marker) {
    MAREY_ASSERT(marker < labels.size());
    MAREY_ASSERT(frame * labels.size() + marker < samples.size());
    return samples[frame * labels.size() + marker];
  }
  /// Time of a frame on the recording's clock. [s]
  [[nodiscard]] double time_s(std::size_t frame) const {
    return start_s + static_cast<double>(frame) / rate.hz;
  }
};

}  // namespace marey
