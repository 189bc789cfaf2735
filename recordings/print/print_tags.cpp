// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_tags.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/assert.h"
#include "recordings/print/print_frame.h"
#include "recordings/print/print_marks.h"
#include "recordings/print/print_pack.h"
#include "recordings/print/print_pieces.h"

namespace marey::recordings {
namespace {

/// The cut marks of two pieces do not meet.
constexpr double kGap_m = 2.0 * kCutMark_m + 0.0004;
constexpr double kTagRounding_m = 1e-9;

constexpr const char* kHowToCut =
    "Cut at the corner marks, leave the white edge, and glue each tag to its segment on "
    "something flat and stiff.";
constexpr const char* kHowToFold =
    "Plates: cut along the solid lines, score and fold the dashed ones away from you, "
    "glue "
    "the flaps under the base. Flat tags: cut at the corner marks, leave the white edge.";

PrintFrame frame_of(const TagSheet& sheet, const std::vector<PrintPiece>& pieces) {
  const auto by_size = [](const TagToPrint& a, const TagToPrint& b) {
    return a.size_m < b.size_m;
  };
  const auto [smallest, largest] =
      std::minmax_element(sheet.tags.begin(), sheet.tags.end(), by_size);
  std::vector<std::string> names;
  bool any_white = false;
  bool any_black = false;
  for (const TagToPrint& tag : sheet.tags) {
    any_white |= tag.family.white_square;
    any_black |= !tag.family.white_square;
    if (std::find(names.begin(), names.end(), tag.family.name) == names.end()) {
      names.push_back(tag.family.name);
    }
  }
  PrintFrame frame;
  for (const std::string& name : names) {
    frame.title.append(frame.title.empty() ? "" : " + ").append(name);
  }
  frame.title += ", " + mm_text(smallest->size_m);
  if (smallest->size_m != largest->size_m) {
    frame.title += " to " + mm_text(largest->size_m);
  }
  const bool folded = std::any_of(
      pieces.begin(), pieces.end(), [](const auto& p) { return p.second != nullptr; });
  frame.how_to = folded ? kHowToFold : kHowToCut;
  const char* square = "black square";
  if (any_white) square = any_black ? "square" : "white square inside the black ring";
  frame.how_to.append(" A tag's size_m is the edge of its ")
      .append(square)
      .append(", which the arrows show.");
  return frame;
}

/// Returns the area without the space for cut marks at the edges.
PrintBox room_for_pieces(const Paper& paper, const PrintFrame& frame) {
  const PrintBox space = space_for_patterns(paper, frame);
  return {space.left + kCutMark_m,
          space.top + kCutMark_m,
          space.right - kCutMark_m,
          space.bottom - kCutMark_m};
}

class Sheet {
 public:
  explicit Sheet(const TagSheet& sheet)
      : sheet_(sheet), pieces_(pieces_of(sheet)), frame_(frame_of(sheet, pieces_)) {
    for (const PrintPiece& piece : pieces_) {
      sizes_.push_back(size_of(piece));
    }
  }

  [[nodiscard]] bool all_fit(const Paper& paper) const {
    const PrintBox room = room_for_pieces(paper, frame_);
    return std::all_of(sizes_.begin(), sizes_.end(), [&](const PieceSize& size) {
      return size.width <= room.width() + kTagRounding_m &&
             size.height <= room.height() + kTagRounding_m;
    });
  }

  /// Returns the positions of the pieces. Precondition: all fit.
  [[nodiscard]] std::vector<PiecePlace> places(const Paper& paper) const {
    return pack(sizes_, room_for_pieces(paper, frame_), kGap_m);
  }

  [[nodiscard]] PrintedDocument draw(const Paper& paper,
                                     const std::vector<PiecePlace>& places) const;
  [[nodiscard]] Error too_large() const;

 private:
  const TagSheet& sheet_;
  std::vector<PrintPiece> pieces_;
  PrintFrame frame_;
  std::vector<PieceSize> sizes_;
};

PrintedDocument Sheet::draw(const Paper& paper,
                            const std::vector<PiecePlace>& places) const {
  PrintedDocument document{"Tags: " + frame_.title, {}};
  const int pages = places.back().page + 1;
  for (int page = 1; page <= pages; ++page) {
    document.pages.push_back(framed_page(paper, frame_, page, pages));
  }
  for (const PiecePlace& place : places) {
    add_piece(document.pages[static_cast<std::size_t>(place.page)],
              pieces_[place.piece],
              place.corner);
  }
  return document;
}

Error Sheet::too_large() const {
  double width_m = 0.0;
  double height_m = 0.0;
  std::size_t largest = 0;
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    if (sizes_[i].width > sizes_[largest].width) largest = i;
    width_m = std::max(width_m, sizes_[i].width);
    height_m = std::max(height_m, sizes_[i].height);
  }
  const PrintBox upright = room_for_pieces(sheet_.paper, frame_);
  return bad_input(
      name_of(pieces_[largest]),
      "with its quiet zone and its name it is " + mm_text(sizes_[largest].width) + " x " +
          mm_text(sizes_[largest].height) + ", and " + sheet_.paper.name +
          " has room for " + mm_text(upright.width()) + " x " + mm_text(upright.height()),
      "use --page " +
          page_that_holds(width_m + 2.0 * kCutMark_m,
                          height_m + 2.0 * kCutMark_m,
                          sheet_.paper,
                          frame_) +
          ", or a smaller tag");
}

}  // namespace

Result<PrintedDocument> lay_out_tags(const TagSheet& sheet) {
  MAREY_ASSERT(!sheet.tags.empty());
  const Status usable = check_paper(sheet.paper);
  if (!usable) return usable.error();
  const Sheet plan(sheet);
  const Paper lying = turned(sheet.paper);
  const bool fits_upright = plan.all_fit(sheet.paper);
  const bool fits_lying = plan.all_fit(lying);
  if (!fits_upright && !fits_lying) return plan.too_large();
  if (!fits_lying) return plan.draw(sheet.paper, plan.places(sheet.paper));
  const std::vector<PiecePlace> on_lying = plan.places(lying);
  if (!fits_upright) return plan.draw(lying, on_lying);
  const std::vector<PiecePlace> on_upright = plan.places(sheet.paper);
  if (on_lying.back().page < on_upright.back().page) return plan.draw(lying, on_lying);
  return plan.draw(sheet.paper, on_upright);
}

}  // namespace marey::recordings
