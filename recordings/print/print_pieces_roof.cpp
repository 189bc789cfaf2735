// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A plate is a prism of paper: two faces with a tag each, at a right angle, over a base.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "recordings/print/print_marks.h"
#include "recordings/print/print_pieces.h"

namespace marey::recordings {
namespace {

/// Distance of a quiet zone from the adjacent fold or cut.
constexpr double kFoldGap_m = 0.001;
constexpr double kCutLine_m = 0.0002;

/// Returns the width of one side of the roof, from fold to fold.
double face_width(const TagArea& area) {
  return area.edge + 2.0 * kFoldGap_m;
}

double flap_width(const TagArea& area) {
  return std::clamp(0.16 * area.edge, 0.006, 0.014);
}

PrintedLine outline(const PrintBox& box) {
  return {{{box.left, box.top},
           {box.right, box.top},
           {box.right, box.bottom},
           {box.left, box.bottom}},
          kCutLine_m,
          Ink::kBlack,
          false,
          true};
}

/// The faces from the side: ridge, left and right foot. [m]
struct Roof {
  glm::dvec2 ridge{0.0};
  glm::dvec2 left{0.0};
  glm::dvec2 right{0.0};
  double height = 0.0;
};

void add_words(PrintedPage& page,
               const std::string& text,
               const glm::dvec2& at,
               double size_m,
               double max_width_m,
               TextStyle style = TextStyle::kPlain) {
  page.shapes.emplace_back(
      PrintedText{text, at, TextSide::kMiddle, size_m, max_width_m, style});
}

void add_roof(PrintedPage& page, const Roof& roof, const PrintPiece& piece, double text) {
  const double h = roof.height;
  page.shapes.emplace_back(PrintedArea{{roof.ridge, roof.right, roof.left}, Ink::kPaper});
  // Both flaps, under the base.
  const double flap = 0.4 * h;
  const double under = 0.06 * h;
  page.shapes.emplace_back(PrintedLine{{roof.left + glm::dvec2(flap, under),
                                        roof.left + glm::dvec2(0.0, under),
                                        roof.ridge,
                                        roof.right + glm::dvec2(0.0, under),
                                        roof.right + glm::dvec2(-flap, under)},
                                       0.0004,
                                       Ink::kBlack});
  page.shapes.emplace_back(PrintedLine{
      {roof.left + glm::dvec2(under, 0.0), roof.right - glm::dvec2(under, 0.0)},
      0.0006,
      Ink::kFaint});
  add_words(page, "90°", roof.ridge + glm::dvec2(0.0, 0.42 * h), text, h);
  add_words(page, "45°", roof.left + glm::dvec2(0.42 * h, -0.08 * h), text, 0.4 * h);
  add_words(page, "45°", roof.right + glm::dvec2(-0.42 * h, -0.08 * h), text, 0.4 * h);
  // The outward direction of each face.
  const double out = 0.16 * h;
  const glm::dvec2 from_left = 0.5 * (roof.ridge + roof.left);
  const glm::dvec2 from_right = 0.5 * (roof.ridge + roof.right);
  const glm::dvec2 to_left = from_left + glm::dvec2(-1.6 * out, -1.6 * out);
  const glm::dvec2 to_right = from_right + glm::dvec2(1.6 * out, -1.6 * out);
  add_arrow(page, from_left, to_left, 0.1 * h);
  add_arrow(page, from_right, to_right, 0.1 * h);
  add_words(page,
            std::to_string(number(piece.first->id)),
            to_left + glm::dvec2(-0.7 * text, 0.0),
            text,
            h,
            TextStyle::kBold);
  add_words(page,
            std::to_string(number(piece.second->id)),
            to_right + glm::dvec2(0.7 * text, 0.0),
            text,
            h,
            TextStyle::kBold);
}

/// The upper side of the limb, as seen along it, below the base.
void add_limb(PrintedPage& page, const Roof& roof, double text) {
  const glm::dvec2 top =
      0.5 * (roof.left + roof.right) + glm::dvec2(0.0, 0.14 * roof.height);
  const double radius = 0.9 * roof.height;
  PrintedLine arc{{}, 0.0002, Ink::kFaint};
  constexpr int kSteps = 24;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double angle = 0.27 * std::numbers::pi * i / kSteps;
    arc.points.push_back(top +
                         radius * glm::dvec2(std::sin(angle), 1.0 - std::cos(angle)));
  }
  page.shapes.emplace_back(arc);
  add_words(page, "limb", top + glm::dvec2(0.0, 1.4 * text), text, roof.height);
}

}  // namespace

PieceSize size_of_strip(const TagArea& area) {
  return {2.0 * (face_width(area) + flap_width(area)),
          kFoldGap_m + area.edge + area.band};
}

PieceSize size_of_base(const TagArea& area) {
  return {std::numbers::sqrt2 * face_width(area), size_of_strip(area).height};
}

void add_strip(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner) {
  const TagArea area = area_of(*piece.first);
  const PieceSize size = size_of_strip(area);
  const double flap = flap_width(area);
  const double face = face_width(area);
  const double bottom = corner.y + size.height;
  page.shapes.emplace_back(outline({corner.x, corner.y, corner.x + size.width, bottom}));
  for (const double x : {flap, flap + face, flap + 2.0 * face}) {
    page.shapes.emplace_back(
        PrintedLine{{{corner.x + x, corner.y}, {corner.x + x, bottom}},
                    kCutLine_m,
                    Ink::kText,
                    true});
  }
  add_tag(page, *piece.first, corner + glm::dvec2(flap + kFoldGap_m, kFoldGap_m));
  add_tag(page, *piece.second, corner + glm::dvec2(flap + face + kFoldGap_m, kFoldGap_m));
  const double text = std::min(0.0026, 0.3 * flap);
  for (const double x : {0.5 * flap, size.width - 0.5 * flap}) {
    const glm::dvec2 middle = corner + glm::dvec2(x, 0.5 * size.height);
    add_words(page, "glue", middle, text, 0.8 * flap);
    add_words(page, "flap", middle + glm::dvec2(0.0, 1.3 * text), text, 0.8 * flap);
  }
}

void add_base(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner) {
  const PieceSize size = size_of_base(area_of(*piece.first));
  page.shapes.emplace_back(
      outline({corner.x, corner.y, corner.x + size.width, corner.y + size.height}));
  const double middle = corner.x + 0.5 * size.width;
  const double text = std::min(0.0032, 0.036 * size.height);
  double y = corner.y + 1.8 * text;
  add_words(page,
            "Base for " + std::to_string(number(piece.first->id)) + " and " +
                std::to_string(number(piece.second->id)),
            {middle, y},
            1.3 * text,
            0.94 * size.width,
            TextStyle::kBold);
  Roof roof;
  roof.height = 0.3 * size.height;
  roof.ridge = {middle, corner.y + 0.2 * size.height};
  roof.left = roof.ridge + glm::dvec2(-roof.height, roof.height);
  roof.right = roof.ridge + glm::dvec2(roof.height, roof.height);
  add_roof(page, roof, piece, text);
  add_limb(page, roof, text);
  constexpr std::array<const char*, 4> kSteps{
      "1  Glue this base to stiff card; cut both pieces.",
      "2  Score the dashed lines; fold them away from you.",
      "3  Glue both flaps under the base.",
      "4  Strap the base to the limb, the ridge along it."};
  y = corner.y + size.height - 1.55 * text * static_cast<double>(kSteps.size());
  for (const char* step : kSteps) {
    page.shapes.emplace_back(PrintedText{step,
                                         {corner.x + 0.05 * size.width, y},
                                         TextSide::kLeft,
                                         text,
                                         0.9 * size.width});
    y += 1.55 * text;
  }
}

}  // namespace marey::recordings
