// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/c3d_analog.h"

#include <cmath>
#include <utility>

namespace marey::recordings {

AnalogScales analog_scales(const C3dInfo& info) {
  const auto channels = static_cast<std::size_t>(info.analog_channels);
  bool is_unsigned = false;
  if (const C3dParameter* p = find_parameter(info.groups, "ANALOG", "FORMAT")) {
    const std::vector<std::string> format = texts(*p);
    is_unsigned = !format.empty() && (format[0] == "UNSIGNED" || format[0] == "unsigned");
  }
  AnalogScales scales;
  scales.offset = numbers_of_all(info.groups, "ANALOG", "OFFSET", is_unsigned);
  scales.scale = numbers_of_all(info.groups, "ANALOG", "SCALE");
  scales.offset.resize(channels, 0.0);
  scales.scale.resize(channels, 1.0);
  double general = 1.0;
  if (const C3dParameter* p = find_parameter(info.groups, "ANALOG", "GEN_SCALE")) {
    const std::vector<double> value = numbers(*p);
    if (!value.empty() && std::isfinite(value[0]) && value[0] != 0.0) general = value[0];
  }
  for (double& scale : scales.scale) scale *= general;
  return scales;
}

Result<AnalogSignals> read_analog(const std::filesystem::path& path) {
  Result<C3dReader> reader = C3dReader::open(path);
  if (!reader) return reader.error();
  const C3dInfo& info = reader->info();
  const AnalogScales scales = analog_scales(info);
  const auto channels = static_cast<std::size_t>(info.analog_channels);
  auto labels = texts_of_all(info.groups, "ANALOG", "LABELS");
  auto units = texts_of_all(info.groups, "ANALOG", "UNITS");
  labels.resize(channels);
  units.resize(channels);
  AnalogSignals analog;
  analog.rate = FrameRate{info.rate_hz * info.analog_per_frame};
  analog.start_s = (info.first_frame - 1) / info.rate_hz;
  for (std::size_t c = 0; c < channels; ++c) {
    analog.signals.push_back({std::move(labels[c]), std::move(units[c]), {}});
  }
  C3dFrame frame;
  for (;;) {
    const Result<bool> more = reader->next(frame);
    if (!more) return more.error();
    if (!*more) return analog;
    for (std::size_t i = 0; i < frame.analog.size(); ++i) {
      const std::size_t c = i % channels;
      analog.signals[c].samples.push_back(scales.value(c, frame.analog[i]));
    }
  }
}

}  // namespace marey::recordings
