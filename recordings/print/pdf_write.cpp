// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/pdf_write.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <variant>

#include <cairo-pdf.h>
#include <cairo.h>

#include "core/base/assert.h"
#include "recordings/base/atomic_file.h"

namespace marey::recordings {
namespace {

/// Converts to Cairo's unit of PDFs, points. A pen scaled to metres would draw dashes of
/// thousandths of a unit as a continuous line.
constexpr double points(double length_m) {
  return length_m * (72.0 / 0.0254);
}

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Pen = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

cairo_status_t append_bytes(void* text, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void choose(cairo_t* pen, Ink ink) {
  double gray = 0.0;
  if (ink == Ink::kText) gray = 0.13;
  if (ink == Ink::kFaint) gray = 0.45;
  if (ink == Ink::kPaper) gray = 0.9;
  cairo_set_source_rgb(pen, gray, gray, gray);
}

void trace(cairo_t* pen, const std::vector<glm::dvec2>& corners) {
  for (const glm::dvec2& p : corners) cairo_line_to(pen, points(p.x), points(p.y));
}

void draw(cairo_t* pen, const PrintedBoxes& shape) {
  choose(pen, shape.ink);
  for (const PrintBox& box : shape.boxes) {
    cairo_rectangle(pen,
                    points(box.left),
                    points(box.top),
                    points(box.width()),
                    points(box.height()));
  }
  cairo_fill(pen);
}

void draw(cairo_t* pen, const PrintedArea& shape) {
  choose(pen, shape.ink);
  trace(pen, shape.corners);
  cairo_close_path(pen);
  cairo_fill(pen);
}

void draw(cairo_t* pen, const PrintedLine& shape) {
  choose(pen, shape.ink);
  trace(pen, shape.points);
  if (shape.closed) cairo_close_path(pen);
  cairo_set_line_width(pen, points(shape.width_m));
  constexpr double kDash[] = {points(0.002), points(0.0012)};
  cairo_set_dash(pen, static_cast<const double*>(kDash), shape.dashed ? 2 : 0, 0.0);
  cairo_stroke(pen);
}

void draw(cairo_t* pen, const PrintedText& shape) {
  choose(pen, shape.ink);
  const bool fixed = shape.style == TextStyle::kFixedWidth;
  const bool bold = shape.style == TextStyle::kBold;
  cairo_select_font_face(pen,
                         fixed ? "monospace" : "sans-serif",
                         CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  const double size = points(shape.size_m);
  const double max_width = points(shape.max_width_m);
  cairo_set_font_size(pen, size);
  cairo_text_extents_t extents;
  cairo_text_extents(pen, shape.text.c_str(), &extents);
  if (extents.x_advance > max_width) {
    cairo_set_font_size(pen, size * max_width / extents.x_advance);
    cairo_text_extents(pen, shape.text.c_str(), &extents);
  }
  double x = points(shape.at.x);
  if (shape.side == TextSide::kMiddle) x -= 0.5 * extents.x_advance;
  if (shape.side == TextSide::kRight) x -= extents.x_advance;
  cairo_move_to(pen, x, points(shape.at.y));
  cairo_show_text(pen, shape.text.c_str());
  cairo_new_path(pen);
}

std::string pdf_bytes(const PrintedDocument& document, cairo_status_t& problem) {
  std::string bytes;
  const Surface surface(
      cairo_pdf_surface_create_for_stream(append_bytes, &bytes, 1.0, 1.0),
      cairo_surface_destroy);
  cairo_surface_t* pdf = surface.get();
  cairo_pdf_surface_restrict_to_version(pdf, CAIRO_PDF_VERSION_1_5);
  cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_TITLE, document.title.c_str());
  cairo_pdf_surface_set_metadata(pdf, CAIRO_PDF_METADATA_CREATOR, "marey");
  // A real date would make the bytes of equal documents differ.
  cairo_pdf_surface_set_metadata(
      pdf, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  for (const PrintedPage& page : document.pages) {
    cairo_pdf_surface_set_size(pdf, points(page.width_m), points(page.height_m));
    const Pen pen(cairo_create(pdf), cairo_destroy);
    for (const PrintedShape& shape : page.shapes) {
      std::visit([&](const auto& one) { draw(pen.get(), one); }, shape);
    }
    cairo_show_page(pen.get());
    problem = std::max(problem, cairo_status(pen.get()));
  }
  cairo_surface_finish(pdf);
  problem = std::max(problem, cairo_surface_status(pdf));
  return bytes;
}

}  // namespace

Status write_pdf(const std::filesystem::path& path, const PrintedDocument& document) {
  MAREY_ASSERT(!document.pages.empty());
  cairo_status_t problem = CAIRO_STATUS_SUCCESS;
  const std::string bytes = pdf_bytes(document, problem);
  if (problem != CAIRO_STATUS_SUCCESS) {
    return Error{Errc::kInternal,
                 path.string(),
                 std::string("Cairo: ") + cairo_status_to_string(problem),
                 "report this with the command that you ran"};
  }
  return write_file(path, bytes);
}

}  // namespace marey::recordings
