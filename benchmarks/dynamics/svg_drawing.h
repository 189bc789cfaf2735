// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace marey {

/// Returns numbers in the form of printf.
inline std::string form(const char* format, double a, double b = 0.0) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

/// Returns a number with a true minus sign.
inline std::string number(const char* format, double value) {
  return (value < 0.0 ? "&#8722;" : "") + form(format, std::abs(value));
}

/// A place or a size in a picture; y grows downwards. [px]
struct Place {
  double x = 0.0;
  double y = 0.0;
};

/// Text of a picture in SVG. `more` are further attributes.
class Drawing {
 public:
  void text(Place at, const std::string& words, const std::string& more = "") {
    body_ += "<text " + form("x=\"%.1f\" y=\"%.1f\" ", at.x, at.y) + more + ">" + words +
             "</text>\n";
  }
  void path(const std::vector<Place>& points, const std::string& more) {
    body_ += "<path d=\"M";
    for (const Place& p : points) {
      if (body_.back() != 'M') body_ += 'L';
      body_ += form("%.1f %.1f", p.x, p.y);
    }
    body_ += "\" " + more + "/>\n";
  }
  void dot(Place at, double radius, const std::string& more) {
    body_ += "<circle " + form("cx=\"%.1f\" cy=\"%.1f\" ", at.x, at.y) +
             form("r=\"%.1f\" ", radius) + more + "/>\n";
  }
  void box(Place at, Place size, const std::string& more) {
    body_ += "<rect " + form("x=\"%.1f\" y=\"%.1f\" ", at.x, at.y) +
             form("width=\"%.1f\" height=\"%.1f\" ", size.x, size.y) + more + "/>\n";
  }
  [[nodiscard]] std::string svg(double width, double height) const {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"" +
           form("0 0 %.0f %.0f\"", width, height) +
           form(" width=\"%.0f\" height=\"%.0f\"", width, height) +
           " font-family=\"sans-serif\" font-size=\"14\" fill=\"#222222\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" +
           body_ + "</svg>\n";
  }

 private:
  std::string body_;
};

}  // namespace marey
