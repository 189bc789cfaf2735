// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/tag_pattern.h"
#include "recordings/print/printed_page.h"

namespace marey::recordings {

inline constexpr double kRoundingM = 1e-9;

/// Returns a synthetic tag: quiet zone, black frame, and a pattern that depends on `id`.
inline TagPattern synthetic_pattern(const TagFamilyShape& family, int id) {
  TagPattern pattern;
  pattern.cells = family.cells;
  pattern.margin_cells = (family.cells - family.square_cells) / 2;
  for (int y = 0; y < pattern.cells; ++y) {
    for (int x = 0; x < pattern.cells; ++x) {
      const int ring = std::min({x, y, pattern.cells - 1 - x, pattern.cells - 1 - y}) -
                       pattern.margin_cells;
      const bool bit = ((x * 5 + y * 3 + id) % 3) == 0;
      const bool white = family.white_square ? ring == 0 || (ring != -1 && bit)
                                             : ring < 0 || (ring > 0 && bit);
      pattern.white.push_back(white ? 1 : 0);
    }
  }
  return pattern;
}

inline TagFamilyShape black_family() {
  return {"tag36h11", 587, 10, 8, false};
}
inline TagFamilyShape white_family() {
  return {"tagStandard41h12", 2115, 9, 5, true};
}

inline bool overlap(const PrintBox& a, const PrintBox& b) {
  constexpr double kTouchM = 1e-6;
  return a.left < b.right - kTouchM && b.left < a.right - kTouchM &&
         a.top < b.bottom - kTouchM && b.top < a.bottom - kTouchM;
}

inline bool holds(const PrintBox& outer, const PrintBox& inner) {
  return inner.left >= outer.left - kRoundingM && inner.top >= outer.top - kRoundingM &&
         inner.right <= outer.right + kRoundingM &&
         inner.bottom <= outer.bottom + kRoundingM;
}

inline PrintBox around(const std::vector<glm::dvec2>& points, double by) {
  PrintBox box{points[0].x, points[0].y, points[0].x, points[0].y};
  for (const glm::dvec2& p : points) {
    box = {std::min(box.left, p.x),
           std::min(box.top, p.y),
           std::max(box.right, p.x),
           std::max(box.bottom, p.y)};
  }
  return {box.left - by, box.top - by, box.right + by, box.bottom + by};
}

/// Area covered by a shape; the width of letters is taken as 0.6 of their height.
struct CoveredBoxes {
  std::vector<PrintBox> operator()(const PrintedBoxes& shape) const {
    return shape.boxes;
  }
  std::vector<PrintBox> operator()(const PrintedArea& shape) const {
    return {around(shape.corners, 0.0)};
  }
  std::vector<PrintBox> operator()(const PrintedLine& shape) const {
    std::vector<PrintBox> boxes;
    for (std::size_t i = 1; i < shape.points.size(); ++i) {
      boxes.push_back(
          around({shape.points[i - 1], shape.points[i]}, 0.5 * shape.width_m));
    }
    if (shape.closed) {
      boxes.push_back(
          around({shape.points.back(), shape.points.front()}, 0.5 * shape.width_m));
    }
    return boxes;
  }
  std::vector<PrintBox> operator()(const PrintedText& shape) const {
    const double width = std::min(
        shape.max_width_m, 0.6 * shape.size_m * static_cast<double>(shape.text.size()));
    double left = shape.at.x;
    if (shape.side == TextSide::kMiddle) left -= 0.5 * width;
    if (shape.side == TextSide::kRight) left -= width;
    return {{left,
             shape.at.y - 0.75 * shape.size_m,
             left + width,
             shape.at.y + 0.22 * shape.size_m}};
  }
};

/// Expects that all content is within the margins, that quiet zones contain only their
/// own tag, and that the ruler is present. `clear_patterns`: patterns are printed inside
/// clear zones and nowhere else.
inline void expect_lawful(const PrintedDocument& document,
                          const Paper& paper,
                          bool clear_patterns) {
  for (const PrintedPage& page : document.pages) {
    const PrintBox inside{paper.margin_m - kRoundingM,
                          paper.margin_m - kRoundingM,
                          page.width_m - paper.margin_m + kRoundingM,
                          page.height_m - paper.margin_m + kRoundingM};
    EXPECT_GE(page.ruler_start.x, paper.margin_m - kRoundingM);
    EXPECT_LE(page.ruler_start.x + 0.1, page.width_m - paper.margin_m + kRoundingM);
    for (std::size_t i = 0; i < page.tags.size(); ++i) {
      EXPECT_TRUE(holds(page.tags[i].clear, page.tags[i].square));
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_FALSE(overlap(page.tags[i].clear, page.tags[j].clear))
            << number(page.tags[i].id) << " and " << number(page.tags[j].id);
      }
    }
    for (const PrintedShape& shape : page.shapes) {
      // Half the width of a line along the margin may exceed it.
      constexpr double kLineM = 0.0002;
      const PrintBox sheet{inside.left - kLineM,
                           inside.top - kLineM,
                           inside.right + kLineM,
                           inside.bottom + kLineM};
      const bool is_pattern = std::holds_alternative<PrintedBoxes>(shape);
      for (const PrintBox& box : std::visit(CoveredBoxes{}, shape)) {
        EXPECT_TRUE(holds(sheet, box))
            << box.left << " " << box.top << " " << box.right << " " << box.bottom
            << (std::holds_alternative<PrintedText>(shape)
                    ? std::get<PrintedText>(shape).text
                    : std::string());
        const auto in = std::find_if(page.tags.begin(), page.tags.end(), [&](auto& tag) {
          return overlap(tag.clear, box);
        });
        if (in == page.tags.end()) {
          EXPECT_FALSE(is_pattern && clear_patterns);
          continue;
        }
        EXPECT_TRUE(is_pattern) << "in the quiet zone of tag " << number(in->id);
        EXPECT_TRUE(holds(in->clear, box) || !clear_patterns);
      }
    }
  }
}

}  // namespace marey::recordings
