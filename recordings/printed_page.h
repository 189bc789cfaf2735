// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "core/ids.h"

namespace marey::recordings {

/// A rectangle of a page. [m] On pages x goes right and y down from the top left corner.
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

/// A sheet to print on, upright.
struct Paper {
  std::string name = "A4";
  double width_m = 0.210;
  double height_m = 0.297;
  double margin_m = 0.010;  ///< On every side; printers cannot reach the edge.
};

enum class Ink {
  kBlack,  ///< Patterns, and what is measured or cut.
  kText,
  kFaint,  ///< Marks and remarks.
  kPaper,  ///< A light grey that shows what is paper.
};

/// Rectangles filled together, so that no seam shows between those that touch.
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
  glm::dvec2 at{0.0};               ///< On the line of writing.
  TextSide side = TextSide::kLeft;  ///< Which side of the text is at `at`.
  double size_m = 0.0032;           ///< Of the font.
  double most_width_m = 1.0;        ///< A longer text is set smaller.
  TextStyle style = TextStyle::kPlain;
  Ink ink = Ink::kText;
};

using PrintedShape = std::variant<PrintedBoxes, PrintedArea, PrintedLine, PrintedText>;

/// A tag that is whole on its page, and where.
struct PrintedTag {
  TagId id{};
  PrintBox square;  ///< Whose corners count.
  PrintBox clear;   ///< What nothing else may be printed in.
};

struct PrintedPage {
  double width_m = 0.0;
  double height_m = 0.0;
  std::vector<PrintedShape> shapes;  ///< In the order of drawing.
  std::vector<PrintedTag> tags;
  glm::dvec2 ruler_start{0.0};  ///< From here the ruler goes 100 mm to the right.
};

struct PrintedDocument {
  std::string title;
  std::vector<PrintedPage> pages;
};

}  // namespace marey::recordings
