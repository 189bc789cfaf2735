// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/tag_pattern.h"
#include "recordings/print/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

/// Length of the cut marks outside of a corner. [m]
inline constexpr double kCutMark_m = 0.0018;

/// Adds two short lines outside of each corner of `box`.
void add_cut_marks(PrintedPage& page, const PrintBox& box);

/// A dimension line: x of both ends, its y, its text and the text's font size `text_m`.
struct Dimension {
  double left = 0.0;
  double right = 0.0;
  double y = 0.0;
  double text_m = 0.0;
  std::string text;
};

/// Adds a line from `left` to `right` with an arrow at each end. The text is in its
/// middle, or beyond its end if the middle is too narrow.
void add_dimension(PrintedPage& page, const Dimension& dimension);

/// Adds a line with an arrow at its end.
void add_arrow(PrintedPage& page,
               const glm::dvec2& from,
               const glm::dvec2& to,
               double head_m,
               Ink ink = Ink::kText);

/// Returns the black cells of a pattern whose top left corner is at `corner`, merged into
/// few large rectangles.
[[nodiscard]] std::vector<PrintBox> black_boxes(const TagPattern& pattern,
                                                const glm::dvec2& corner,
                                                double cell_m);

}  // namespace marey::recordings
