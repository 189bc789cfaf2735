// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/time.h"
#include "recordings/c3d.h"

namespace marey::recordings {

/// How the words of each analog channel become its unit:
/// value = (word - offset) * scale, the general scale included.
struct AnalogScales {
  std::vector<double> offset;
  std::vector<double> scale;

  [[nodiscard]] double value(std::size_t channel, float word) const {
    return (static_cast<double>(word) - offset[channel]) * scale[channel];
  }
};

/// Of ANALOG:OFFSET, SCALE and GEN_SCALE; what is missing is 0, 1 and 1.
[[nodiscard]] AnalogScales analog_scales(const C3dInfo& info);

/// A signal that was sampled beside the cameras: a muscle, a plate's voltage.
struct AnalogSignal {
  std::string label;
  std::string unit;             ///< As the file calls it; may be empty.
  std::vector<double> samples;  ///< In its unit.
};

struct AnalogSignals {
  FrameRate rate;
  double start_s = 0.0;  ///< Of the first sample, on the clock of the markers.
  std::vector<AnalogSignal> signals;
};

/// All analog channels of a C3D. Errors as C3dReader's. Cost: memory for every sample.
[[nodiscard]] Result<AnalogSignals> read_analog(const std::filesystem::path& path);

}  // namespace marey::recordings
