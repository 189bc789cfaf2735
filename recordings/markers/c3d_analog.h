// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "recordings/markers/c3d.h"

namespace marey::recordings {

/// Conversion of each analog channel's words to its unit:
/// value = (word - offset) * scale, the general scale included.
struct AnalogScales {
  std::vector<double> offset;
  std::vector<double> scale;

  [[nodiscard]] double value(std::size_t channel, float word) const {
    return (static_cast<double>(word) - offset[channel]) * scale[channel];
  }
};

/// Reads ANALOG:OFFSET, SCALE and GEN_SCALE. Defaults are 0, 1 and 1.
[[nodiscard]] AnalogScales analog_scales(const C3dInfo& info);

/// A signal recorded together with the markers: a muscle's EMG, a plate's voltage.
struct AnalogSignal {
  std::string label;
  std::string unit;             ///< Its name in the file; may be empty.
  std::vector<double> samples;  ///< In `unit`.
};

struct AnalogSignals {
  FrameRate rate;
  double start_s = 0.0;  ///< Time of the first sample, on the clock of the markers.
  std::vector<AnalogSignal> signals;
};

/// Reads all analog channels of a C3D. Errors: those of C3dReader. Cost: memory for every
/// sample.
[[nodiscard]] Result<AnalogSignals> read_analog(const std::filesystem::path& path);

}  // namespace marey::recordings
