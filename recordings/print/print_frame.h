// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "recordings/print/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

/// Content around the patterns on each page of a document: title and instructions above,
/// the ruler and a small table below.
struct PrintFrame {
  std::string title;
  std::string how_to;
  std::vector<std::string> table;  ///< Lines, in a fixed-width font.
};

/// Returns the area for the patterns. May be empty or inverted on small paper.
[[nodiscard]] PrintBox space_for_patterns(const Paper& paper, const PrintFrame& frame);

/// Returns a page with its frame. `page` counts from 1.
[[nodiscard]] PrintedPage framed_page(const Paper& paper,
                                      const PrintFrame& frame,
                                      int page,
                                      int pages);

/// Checks the paper. Errors (kBadInput): it is too small for the ruler, or its margin is
/// too large.
[[nodiscard]] Status check_paper(const Paper& paper);

/// Returns the sheet in the other orientation.
[[nodiscard]] Paper turned(const Paper& paper);

/// Returns the value of --page that provides at least this much space for patterns in
/// this frame: the smaller of A4 and A3 that does, or "420x594mm".
[[nodiscard]] std::string page_that_holds(double width_m,
                                          double height_m,
                                          const Paper& paper,
                                          const PrintFrame& frame);

/// Returns "80 mm", with a resolution of a micrometre.
[[nodiscard]] std::string mm_text(double length_m);

}  // namespace marey::recordings
