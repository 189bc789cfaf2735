// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "recordings/print/print_pack.h"
#include "recordings/print/tag_sheet.h"

// Private to recordings/.
namespace marey::recordings {

/// A part that is cut out in one piece.
struct PrintPiece {
  enum class Kind {
    kTag,    ///< A flat tag.
    kStrip,  ///< Two tags, to be folded into a roof.
    kBase,   ///< The base to which the roof is glued.
  };
  Kind kind = Kind::kTag;
  const TagToPrint* first = nullptr;
  const TagToPrint* second = nullptr;  ///< nullptr for a flat tag.
};

/// Returns the pieces of a sheet, in its order; they point into the sheet.
[[nodiscard]] std::vector<PrintPiece> pieces_of(const TagSheet& sheet);

[[nodiscard]] PieceSize size_of(const PrintPiece& piece);

/// Returns "tag 41", or "the plate of tags 41 and 44".
[[nodiscard]] std::string name_of(const PrintPiece& piece);

/// Draws a piece with its top left corner at `corner`.
void add_piece(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner);

/// Size of a tag on a flat piece or on one face of a roof: pattern and quiet zone.
struct TagArea {
  double cell = 0.0;   ///< [m]
  double quiet = 0.0;  ///< White border in addition to the pattern's own. [m]
  double edge = 0.0;   ///< Edge of the pattern with its quiet zone. [m]
  double band = 0.0;   ///< Height of the text below. [m]
};

[[nodiscard]] TagArea area_of(const TagToPrint& tag);

/// Draws a tag and the text below it.
void add_tag(PrintedPage& page, const TagToPrint& tag, const glm::dvec2& corner);

// print_pieces_roof.cpp
[[nodiscard]] PieceSize size_of_strip(const TagArea& area);
[[nodiscard]] PieceSize size_of_base(const TagArea& area);
void add_strip(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner);
void add_base(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner);

}  // namespace marey::recordings
