// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_marks.h"

#include <cstddef>

#include <glm/geometric.hpp>

namespace marey::recordings {
namespace {

constexpr double kThin_m = 0.00012;

}  // namespace

void add_cut_marks(PrintedPage& page, const PrintBox& box) {
  constexpr double kGap_m = 0.0004;
  for (const bool right : {false, true}) {
    for (const bool bottom : {false, true}) {
      const glm::dvec2 corner{right ? box.right : box.left,
                              bottom ? box.bottom : box.top};
      const double x = right ? 1.0 : -1.0;
      const double y = bottom ? 1.0 : -1.0;
      page.shapes.emplace_back(PrintedLine{
          {{corner.x + kGap_m * x, corner.y}, {corner.x + kCutMark_m * x, corner.y}},
          kThin_m,
          Ink::kFaint});
      page.shapes.emplace_back(PrintedLine{
          {{corner.x, corner.y + kGap_m * y}, {corner.x, corner.y + kCutMark_m * y}},
          kThin_m,
          Ink::kFaint});
    }
  }
}

void add_arrow(PrintedPage& page,
               const glm::dvec2& from,
               const glm::dvec2& to,
               double head_m,
               Ink ink) {
  const double length = glm::distance(from, to);
  if (!(length > 0.0)) return;
  const glm::dvec2 along = (to - from) / length;
  const glm::dvec2 across{-along.y, along.x};
  const glm::dvec2 neck = to - head_m * along;
  page.shapes.emplace_back(PrintedLine{{from, neck}, kThin_m, ink});
  page.shapes.emplace_back(
      PrintedArea{{to, neck + 0.3 * head_m * across, neck - 0.3 * head_m * across}, ink});
}

void add_dimension(PrintedPage& page, const Dimension& d) {
  // Approximate width of a letter; the text also needs a margin. [em]
  constexpr double kLetter = 0.58;
  const double room = (static_cast<double>(d.text.size()) * kLetter + 0.8) * d.text_m;
  const double head = 0.8 * d.text_m;
  const double middle = 0.5 * (d.left + d.right);
  const double baseline = d.y + 0.36 * d.text_m;
  for (const double x : {d.left, d.right}) {
    page.shapes.emplace_back(PrintedLine{
        {{x, d.y - 0.7 * d.text_m}, {x, d.y + 0.7 * d.text_m}}, kThin_m, Ink::kText});
  }
  if (room + 2.0 * head <= d.right - d.left) {
    add_arrow(page, {middle - 0.5 * room, d.y}, {d.left, d.y}, head);
    add_arrow(page, {middle + 0.5 * room, d.y}, {d.right, d.y}, head);
    page.shapes.emplace_back(
        PrintedText{d.text, {middle, baseline}, TextSide::kMiddle, d.text_m, room});
    return;
  }
  add_arrow(page, {d.left - 2.0 * head, d.y}, {d.left, d.y}, head);
  add_arrow(page, {d.right + 2.0 * head, d.y}, {d.right, d.y}, head);
  page.shapes.emplace_back(PrintedText{
      d.text, {d.right + 2.4 * head, baseline}, TextSide::kLeft, d.text_m, 2.0 * room});
}

std::vector<PrintBox> black_boxes(const TagPattern& pattern,
                                  const glm::dvec2& corner,
                                  double cell_m) {
  const auto cells = static_cast<std::size_t>(pattern.cells);
  std::vector<bool> left(pattern.white.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = pattern.white[i] == 0;
  const auto whole_row = [&](std::size_t y, std::size_t from, std::size_t to) {
    for (std::size_t x = from; x < to; ++x) {
      if (!left[y * cells + x]) return false;
    }
    return true;
  };
  std::vector<PrintBox> boxes;
  for (std::size_t y = 0; y < cells; ++y) {
    for (std::size_t x = 0; x < cells; ++x) {
      if (!left[y * cells + x]) continue;
      std::size_t right = x + 1;
      while (right < cells && left[y * cells + right]) ++right;
      std::size_t bottom = y + 1;
      while (bottom < cells && whole_row(bottom, x, right)) ++bottom;
      for (std::size_t row = y; row < bottom; ++row) {
        for (std::size_t column = x; column < right; ++column) {
          left[row * cells + column] = false;
        }
      }
      boxes.push_back({corner.x + static_cast<double>(x) * cell_m,
                       corner.y + static_cast<double>(y) * cell_m,
                       corner.x + static_cast<double>(right) * cell_m,
                       corner.y + static_cast<double>(bottom) * cell_m});
    }
  }
  return boxes;
}

}  // namespace marey::recordings
