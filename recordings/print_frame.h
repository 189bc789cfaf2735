// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "recordings/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

/// What surrounds the patterns on each page of a document: a title and how to use the
/// page above, the ruler and a small table below.
struct PageFrame {
  std::string title;
  std::string how_to;
  std::vector<std::string> table;  ///< Lines, set in a fixed width.
};

/// Where the patterns may go. May be empty or worse on small paper.
[[nodiscard]] PrintBox space_for_patterns(const Paper& paper, const PageFrame& frame);

/// A page with its frame. `page` counts from 1.
[[nodiscard]] PrintedPage framed_page(const Paper& paper,
                                      const PageFrame& frame,
                                      int page,
                                      int pages);

/// Errors (kBadInput): the paper is too small for the ruler, or its margin is too large.
[[nodiscard]] Status check_paper(const Paper& paper);

/// The same sheet lying on its side.
[[nodiscard]] Paper turned(const Paper& paper);

/// What to write after --page to get at least this much space for patterns in this frame:
/// the smallest of A4, A3 that has it, or "420x594mm".
[[nodiscard]] std::string page_that_holds(double width_m,
                                          double height_m,
                                          const Paper& paper,
                                          const PageFrame& frame);

/// "80 mm", to a micrometre.
[[nodiscard]] std::string mm_text(double length_m);

}  // namespace marey::recordings
