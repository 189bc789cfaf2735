// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_pieces.h"

#include <algorithm>
#include <cstddef>

#include "recordings/print/print_frame.h"
#include "recordings/print/print_marks.h"

namespace marey::recordings {
namespace {

bool is_on_a_plate(const TagToPrint& tag) {
  if (!tag.segment) return true;
  return std::any_of(
      human_limbs().begin(), human_limbs().end(), [&](const HumanLimb& limb) {
        return tag.segment == limb.upper || tag.segment == limb.lower;
      });
}

/// Returns the index of the partner of `tags[i]` among the unpaired tags, if any.
std::optional<std::size_t> partner_of(const std::vector<TagToPrint>& tags,
                                      const std::vector<bool>& taken,
                                      std::size_t i) {
  if (!is_on_a_plate(tags[i])) return std::nullopt;
  for (std::size_t j = i + 1; j < tags.size(); ++j) {
    const bool fits = tags[j].segment == tags[i].segment &&
                      tags[j].size_m == tags[i].size_m &&
                      tags[j].family.name == tags[i].family.name;
    if (fits && !taken[j]) return j;
  }
  return std::nullopt;
}

}  // namespace

std::vector<PrintPiece> pieces_of(const TagSheet& sheet) {
  using Kind = PrintPiece::Kind;
  std::vector<PrintPiece> pieces;
  std::vector<bool> taken(sheet.tags.size(), false);
  for (std::size_t i = 0; i < sheet.tags.size(); ++i) {
    if (taken[i]) continue;
    const auto partner =
        sheet.plates ? partner_of(sheet.tags, taken, i) : std::optional<std::size_t>{};
    if (!partner) {
      pieces.push_back({Kind::kTag, &sheet.tags[i], nullptr});
      continue;
    }
    taken[*partner] = true;
    pieces.push_back({Kind::kStrip, &sheet.tags[i], &sheet.tags[*partner]});
    pieces.push_back({Kind::kBase, &sheet.tags[i], &sheet.tags[*partner]});
  }
  return pieces;
}

TagArea area_of(const TagToPrint& tag) {
  TagArea area;
  area.cell = tag.size_m / tag.family.square_cells;
  area.quiet = tag.family.white_square ? area.cell : 0.0;
  area.edge = tag.family.cells * area.cell + 2.0 * area.quiet;
  area.band = std::clamp(0.1 * area.edge, 0.004, 0.009);
  return area;
}

PieceSize size_of(const PrintPiece& piece) {
  const TagArea area = area_of(*piece.first);
  if (piece.kind == PrintPiece::Kind::kStrip) return size_of_strip(area);
  if (piece.kind == PrintPiece::Kind::kBase) return size_of_base(area);
  return {area.edge, area.edge + area.band};
}

std::string name_of(const PrintPiece& piece) {
  const std::string first = std::to_string(number(piece.first->id));
  if (piece.second == nullptr) return "tag " + first;
  return "the plate of tags " + first + " and " +
         std::to_string(number(piece.second->id));
}

void add_tag(PrintedPage& page, const TagToPrint& tag, const glm::dvec2& corner) {
  const TagArea area = area_of(tag);
  page.shapes.emplace_back(PrintedBoxes{
      black_boxes(tag.pattern, corner + glm::dvec2(area.quiet), area.cell), Ink::kBlack});
  const double inset = 0.5 * (area.edge - tag.size_m);
  PrintedTag printed;
  printed.id = tag.id;
  printed.clear = {corner.x, corner.y, corner.x + area.edge, corner.y + area.edge};
  printed.square = {corner.x + inset,
                    corner.y + inset,
                    corner.x + inset + tag.size_m,
                    corner.y + inset + tag.size_m};
  page.tags.push_back(printed);

  const double below = corner.y + area.edge;
  add_dimension(page,
                {printed.square.left,
                 printed.square.right,
                 below + 0.24 * area.band,
                 0.3 * area.band,
                 mm_text(tag.size_m)});
  std::string label = std::to_string(number(tag.id));
  if (tag.segment) label.append("  ").append(name(*tag.segment));
  page.shapes.emplace_back(
      PrintedText{label,
                  {corner.x + 0.02 * area.edge, below + 0.84 * area.band},
                  TextSide::kLeft,
                  0.4 * area.band,
                  0.62 * area.edge,
                  TextStyle::kBold,
                  Ink::kBlack});
  page.shapes.emplace_back(
      PrintedText{tag.family.name,
                  {corner.x + 0.98 * area.edge, below + 0.84 * area.band},
                  TextSide::kRight,
                  0.28 * area.band,
                  0.3 * area.edge,
                  TextStyle::kPlain,
                  Ink::kFaint});
}

void add_piece(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner) {
  if (piece.kind == PrintPiece::Kind::kStrip) return add_strip(page, piece, corner);
  if (piece.kind == PrintPiece::Kind::kBase) return add_base(page, piece, corner);
  add_tag(page, *piece.first, corner);
  const PieceSize size = size_of(piece);
  add_cut_marks(page,
                {corner.x, corner.y, corner.x + size.width, corner.y + size.height});
}

}  // namespace marey::recordings
