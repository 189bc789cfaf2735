// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/ids.h"

namespace marey::recordings {

/// A rectangle of a page. [m] On pages x is right and y down from the top left corner.
struct PrintBox {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
  [[nodiscard]] glm::dvec2 middle() const {
    return {0.5 * (left + right), 0.5 * (top + bottom)};
  }
};

/// A sheet of paper in portrait orientation.
struct Paper {
  std::string name = "A4";
  double width_m = 0.210;
  double height_m = 0.297;
  double margin_m = 0.010;  ///< On every side; printers cannot reach the edge.
};

enum class Ink {
  kBlack,  ///< Patterns, rulers and lines to cut.
  kText,
  kFaint,  ///< Marks and remarks.
  kPaper,  ///< A light grey that marks the area of the paper.
};

/// Rectangles filled together, so that adjacent ones have no visible seam.
struct PrintedBoxes {
  std::vector<PrintBox> boxes;
  Ink ink = Ink::kBlack;
};

/// A filled polygon.
struct PrintedArea {
  std::vector<glm::dvec2> corners;
  Ink ink = Ink::kBlack;
};

struct PrintedLine {
  std::vector<glm::dvec2> points;
  double width_m = 0.0002;
  Ink ink = Ink::kBlack;
  bool dashed = false;
  bool closed = false;
};

enum class TextSide { kLeft, kMiddle, kRight };
enum class TextStyle { kPlain, kBold, kFixedWidth };

struct PrintedText {
  std::string text;
  glm::dvec2 at{0.0};               ///< On the baseline.
  TextSide side = TextSide::kLeft;  ///< The side of the text that is at `at`.
  double size_m = 0.0032;           ///< Font size.
  double max_width_m = 1.0;         ///< A longer text is set in a smaller font.
  TextStyle style = TextStyle::kPlain;
  Ink ink = Ink::kText;
};

using PrintedShape = std::variant<PrintedBoxes, PrintedArea, PrintedLine, PrintedText>;

/// A tag that is complete on its page, and its position.
struct PrintedTag {
  TagId id{};
  PrintBox square;  ///< The square whose corners are detected.
  PrintBox clear;   ///< Area that must stay free of other content.
};

struct PrintedPage {
  double width_m = 0.0;
  double height_m = 0.0;
  std::vector<PrintedShape> shapes;  ///< In drawing order.
  std::vector<PrintedTag> tags;
  glm::dvec2 ruler_start{0.0};  ///< Left end of the ruler, which is 100 mm long.
};

struct PrintedDocument {
  std::string title;
  std::vector<PrintedPage> pages;
};

}  // namespace marey::recordings
