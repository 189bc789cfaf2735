// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/tag_pattern.h"
#include "recordings/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

/// How far outside of a corner its cut marks reach. [m]
inline constexpr double kCutMark_m = 0.0018;

/// Two short lines outside of each corner of `box`.
void add_cut_marks(PrintedPage& page, const PrintBox& box);

/// Where arrows begin and end, at the same height, and what they measure; `text_m` is
/// the size of its letters.
struct Dimension {
  double left = 0.0;
  double right = 0.0;
  double y = 0.0;
  double text_m = 0.0;
  std::string text;
};

/// A line from `left` to `right` with an arrow at each end and the text in its middle, or
/// beyond its end when the middle is too narrow.
void add_dimension(PrintedPage& page, const Dimension& dimension);

/// A line with an arrow at its end.
void add_arrow(PrintedPage& page,
               const glm::dvec2& from,
               const glm::dvec2& to,
               double head_m,
               Ink ink = Ink::kText);

/// The black cells of a pattern whose top left corner is at `corner`, few large
/// rectangles rather than many small ones.
[[nodiscard]] std::vector<PrintBox> black_boxes(const TagPattern& pattern,
                                                const glm::dvec2& corner,
                                                double cell_m);

}  // namespace marey::recordings
