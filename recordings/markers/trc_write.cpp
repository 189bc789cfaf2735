// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/assert.h"
#include "recordings/base/number_text.h"
#include "recordings/base/text_reader.h"
#include "recordings/markers/trc.h"

namespace marey::recordings {
namespace {

/// 15 digits reproduce a decimal number that was read; a computed number may need 17.
void append_length(std::string& text, double value, double per_metre, double length_m) {
  std::array<char, 64> digits{};
  const auto [end, problem] = std::to_chars(digits.data(),
                                            digits.data() + digits.size(),
                                            value,
                                            std::chars_format::general,
                                            15);
  const std::string_view shown(digits.data(),
                               static_cast<std::size_t>(end - digits.data()));
  const auto read = to_number(shown);
  if (problem == std::errc{} && read && *read / per_metre == length_m) {
    text += shown;
  } else {
    append_exact(text, value);
  }
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

void append_header(std::string& text,
                   const MarkerTracks& tracks,
                   const FileAxes& axes,
                   const std::string& name) {
  text += "PathFileType\t4\t(X/Y/Z)\t" + one_line(name) + "\n";
  text +=
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
      "OrigDataStartFrame\tOrigNumFrames\n";
  const auto rate = [&] {
    append_exact(text, tracks.rate.hz);
    text += '\t';
  };
  rate();
  rate();
  text += std::to_string(tracks.frames()) + "\t" + std::to_string(tracks.markers()) +
          "\t" + axes.unit + "\t";
  rate();
  text +=
      std::to_string(tracks.first_frame) + "\t" + std::to_string(tracks.frames()) + "\n";
  text += "Frame#\tTime";
  for (const std::string& label : tracks.labels) {
    text += '\t';
    text += one_line(label);
    text += "\t\t";
  }
  text += "\n\t";
  for (std::size_t i = 1; i <= tracks.markers(); ++i) {
    for (const char axis : {'X', 'Y', 'Z'}) {
      text += '\t';
      text += axis;
      text += std::to_string(i);
    }
  }
  text += "\n\n";
}

}  // namespace

std::string trc_text(const MarkerTracks& tracks,
                     const FileAxes& axes,
                     const std::string& name) {
  MAREY_ASSERT(tracks.rate.hz > 0.0);
  std::string text;
  append_header(text, tracks, axes, name);
  for (std::size_t frame = 0; frame < tracks.frames(); ++frame) {
    text += std::to_string(tracks.first_frame + static_cast<int>(frame)) + "\t";
    append_fixed(text, tracks.time_s(frame), 9);
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      const auto& sample = tracks.at(frame, m);
      if (!sample) {
        text += "\t\t\t";
        continue;
      }
      const glm::dvec3 p_m = turned_to_file(axes.up, sample->p_in_world);
      MAREY_ASSERT(std::isfinite(p_m.x) && std::isfinite(p_m.y) && std::isfinite(p_m.z));
      for (int i = 0; i < 3; ++i) {
        text += '\t';
        append_length(text, p_m[i] * axes.per_metre, axes.per_metre, p_m[i]);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace marey::recordings
