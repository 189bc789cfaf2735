// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/page_text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>

namespace marey::app {

std::string text_of(const char* format, double a, double b, double c) {
  char text[400];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Colour map Cividis (Nunez, Anderton, Renslow 2018), the same as in the report: 0 is
/// dark blue.
std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 6> kStops{{{0.0, 0.135, 0.305},
                                                         {0.2, 0.27, 0.43},
                                                         {0.42, 0.42, 0.445},
                                                         {0.65, 0.6, 0.47},
                                                         {0.87, 0.78, 0.37},
                                                         {1.0, 0.92, 0.27}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  std::array<double, 3> mixed{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = place - static_cast<double>(i);
    mixed[k] = 255.0 * (kStops[i][k] + part * (kStops[i + 1][k] - kStops[i][k]));
  }
  return text_of("rgb(%.0f %.0f %.0f)", mixed[0], mixed[1], mixed[2]);
}

}  // namespace marey::app
