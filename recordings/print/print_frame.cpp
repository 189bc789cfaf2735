// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <sstream>

#include "recordings/base/number_text.h"

namespace marey::recordings {
namespace {

constexpr double kTitle_m = 0.0055;
constexpr double kText_m = 0.0031;
constexpr double kLine_m = 0.0045;  ///< Distance of text lines.
constexpr double kTableText_m = 0.0026;
constexpr double kTableLine_m = 0.0034;
constexpr double kRuler_m = 0.100;
constexpr double kRulerBlock_m = 0.0165;  ///< Height of the ruler with its text.
constexpr double kTableGap_m = 0.010;
/// Width of a letter in most sans-serif fonts, slightly rounded up. [em]
constexpr double kLetter = 0.56;
constexpr double kFixedLetter = 0.61;

std::vector<std::string> wrapped(const std::string& text, double width_m) {
  const auto max_letters = static_cast<std::size_t>(width_m / (kLetter * kText_m));
  std::vector<std::string> lines;
  std::istringstream words(text);
  std::string word;
  while (words >> word) {
    if (lines.empty() || lines.back().size() + 1 + word.size() > max_letters) {
      lines.push_back(word);
    } else {
      lines.back().append(" ").append(word);
    }
  }
  return lines;
}

double table_width(const PrintFrame& frame) {
  std::size_t letters = 0;
  for (const std::string& line : frame.table) letters = std::max(letters, line.size());
  return static_cast<double>(letters) * kFixedLetter * kTableText_m;
}

double table_height(const PrintFrame& frame) {
  return static_cast<double>(frame.table.size()) * kTableLine_m;
}

double inner_width(const Paper& paper) {
  return paper.width_m - 2.0 * paper.margin_m;
}

bool fits_next_to_ruler(const Paper& paper, const PrintFrame& frame) {
  return kRuler_m + kTableGap_m + table_width(frame) <= inner_width(paper);
}

double header_height(const Paper& paper, const PrintFrame& frame) {
  const auto lines =
      static_cast<double>(wrapped(frame.how_to, inner_width(paper)).size());
  return kTitle_m + 0.0015 + lines * kLine_m + 0.003;
}

double footer_height(const Paper& paper, const PrintFrame& frame) {
  const double table = table_height(frame);
  if (frame.table.empty()) return kRulerBlock_m + 0.003;
  if (fits_next_to_ruler(paper, frame)) return std::max(kRulerBlock_m, table) + 0.003;
  return kRulerBlock_m + table + 0.005;
}

/// Adds the ruler. `top` is that of the block: numbers, ticks, the line, and
/// instructions.
void add_ruler(PrintedPage& page, double left, double top) {
  const double line = top + 0.0075;
  page.ruler_start = {left, line};
  page.shapes.emplace_back(
      PrintedLine{{{left, line}, {left + kRuler_m, line}}, 0.0002, Ink::kBlack});
  for (int cm = 0; cm <= 10; ++cm) {
    const double x = left + 0.01 * cm;
    const double length = cm % 5 == 0 ? 0.004 : 0.0025;
    page.shapes.emplace_back(
        PrintedLine{{{x, line - length}, {x, line}}, 0.00015, Ink::kBlack});
    if (cm % 5 != 0) continue;
    const TextSide side = cm == 0   ? TextSide::kLeft
                          : cm == 5 ? TextSide::kMiddle
                                    : TextSide::kRight;
    page.shapes.emplace_back(PrintedText{
        cm == 10 ? "100 mm" : std::to_string(10 * cm), {x, line - 0.0047}, side, 0.0026});
  }
  page.shapes.emplace_back(PrintedText{"Measure this line: it must be 100 mm long.",
                                       {left, line + 0.0038},
                                       TextSide::kLeft,
                                       kText_m,
                                       kRuler_m,
                                       TextStyle::kBold});
  page.shapes.emplace_back(
      PrintedText{"If not, print again at 100 % (\"actual size\"), not \"fit to page\".",
                  {left, line + 0.0077},
                  TextSide::kLeft,
                  0.0028,
                  kRuler_m});
}

void add_header(PrintedPage& page,
                const Paper& paper,
                const PrintFrame& frame,
                const std::string& count) {
  const double left = paper.margin_m;
  const double right = paper.width_m - paper.margin_m;
  double y = paper.margin_m + kTitle_m * 0.85;
  page.shapes.emplace_back(PrintedText{frame.title,
                                       {left, y},
                                       TextSide::kLeft,
                                       kTitle_m,
                                       inner_width(paper) - 0.03,
                                       TextStyle::kBold,
                                       Ink::kBlack});
  page.shapes.emplace_back(PrintedText{count,
                                       {right, y},
                                       TextSide::kRight,
                                       kText_m,
                                       0.028,
                                       TextStyle::kPlain,
                                       Ink::kFaint});
  y += 0.0018;
  for (const std::string& line : wrapped(frame.how_to, inner_width(paper))) {
    y += kLine_m;
    page.shapes.emplace_back(
        PrintedText{line, {left, y}, TextSide::kLeft, kText_m, inner_width(paper)});
  }
}

void add_table(PrintedPage& page, const Paper& paper, const PrintFrame& frame) {
  if (frame.table.empty()) return;
  const bool next_to_ruler = fits_next_to_ruler(paper, frame);
  const double bottom =
      paper.height_m - paper.margin_m - (next_to_ruler ? 0.0 : kRulerBlock_m);
  const double left = next_to_ruler ? paper.width_m - paper.margin_m - table_width(frame)
                                    : paper.margin_m;
  double y = bottom - table_height(frame);
  for (const std::string& line : frame.table) {
    y += kTableLine_m;
    page.shapes.emplace_back(PrintedText{line,
                                         {left, y - 0.0008},
                                         TextSide::kLeft,
                                         kTableText_m,
                                         inner_width(paper),
                                         TextStyle::kFixedWidth});
  }
}

}  // namespace

PrintBox space_for_patterns(const Paper& paper, const PrintFrame& frame) {
  return {paper.margin_m,
          paper.margin_m + header_height(paper, frame),
          paper.width_m - paper.margin_m,
          paper.height_m - paper.margin_m - footer_height(paper, frame)};
}

PrintedPage framed_page(const Paper& paper,
                        const PrintFrame& frame,
                        int page,
                        int pages) {
  PrintedPage out;
  out.width_m = paper.width_m;
  out.height_m = paper.height_m;
  add_header(
      out, paper, frame, "page " + std::to_string(page) + " of " + std::to_string(pages));
  add_ruler(out, paper.margin_m, paper.height_m - paper.margin_m - kRulerBlock_m);
  add_table(out, paper, frame);
  return out;
}

Status check_paper(const Paper& paper) {
  constexpr double kMin_m = kRuler_m + 0.004;
  const double shorter = std::min(paper.width_m, paper.height_m) - 2.0 * paper.margin_m;
  if (shorter >= kMin_m) return Done{};
  return bad_input("page",
                   paper.name + " with margins of " + mm_text(paper.margin_m) +
                       " is too small for the 100 mm ruler",
                   "use a page whose shorter edge is at least " +
                       mm_text(kMin_m + 2.0 * paper.margin_m) + ", such as A4");
}

Paper turned(const Paper& paper) {
  return {paper.name, paper.height_m, paper.width_m, paper.margin_m};
}

std::string page_that_holds(double width_m,
                            double height_m,
                            const Paper& paper,
                            const PrintFrame& frame) {
  constexpr double kRounding_m = 1e-9;
  const std::array<Paper, 2> known{
      {{"A4", 0.210, 0.297, paper.margin_m}, {"A3", 0.297, 0.420, paper.margin_m}}};
  for (const Paper& upright : known) {
    for (const Paper& sheet : {upright, turned(upright)}) {
      const PrintBox space = space_for_patterns(sheet, frame);
      if (space.width() >= width_m - kRounding_m &&
          space.height() >= height_m - kRounding_m) {
        return sheet.name;
      }
    }
  }
  Paper large = paper;
  large.width_m = std::max(width_m, kRuler_m + 0.004) + 2.0 * paper.margin_m;
  large.height_m = 1.0;
  const double around = large.height_m - space_for_patterns(large, frame).height();
  const auto whole_mm = [](double length_m) {
    return std::to_string(static_cast<int>(std::ceil(length_m * 1e3 - 1e-6)));
  };
  return whole_mm(large.width_m) + "x" + whole_mm(height_m + around) + "mm";
}

std::string mm_text(double length_m) {
  std::string text;
  append_exact(text, std::round(length_m * 1e6) / 1e3);
  return text + " mm";
}

}  // namespace marey::recordings
