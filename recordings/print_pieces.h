// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "recordings/print_pack.h"
#include "recordings/print_tags.h"

// Private to recordings/.
namespace marey::recordings {

/// What is cut out in one piece.
struct PrintPiece {
  enum class Kind {
    kTag,    ///< A flat tag.
    kStrip,  ///< Two tags, to be folded to a roof.
    kBase,   ///< What the roof is glued to.
  };
  Kind kind = Kind::kTag;
  const TagToPrint* first = nullptr;
  const TagToPrint* second = nullptr;  ///< nullptr for a flat tag.
};

/// The pieces of a sheet, in its order; they point into it.
[[nodiscard]] std::vector<PrintPiece> pieces_of(const TagSheet& sheet);

[[nodiscard]] PieceSize size_of(const PrintPiece& piece);

/// "tag 41", or "the plate of tags 41 and 44".
[[nodiscard]] std::string name_of(const PrintPiece& piece);

/// Draws it with its top left corner at `corner`.
void add_piece(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner);

/// A tag as it lies flat or on one face: its whole pattern and quiet zone.
struct TagArea {
  double cell = 0.0;   ///< [m]
  double quiet = 0.0;  ///< White that the pattern itself lacks. [m]
  double edge = 0.0;   ///< Of the pattern with its quiet zone. [m]
  double band = 0.0;   ///< Height of what is written below. [m]
};

[[nodiscard]] TagArea area_of(const TagToPrint& tag);

/// Draws the tag and what is written below it.
void add_tag(PrintedPage& page, const TagToPrint& tag, const glm::dvec2& corner);

// print_plates.cpp
[[nodiscard]] PieceSize size_of_strip(const TagArea& area);
[[nodiscard]] PieceSize size_of_base(const TagArea& area);
void add_strip(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner);
void add_base(PrintedPage& page, const PrintPiece& piece, const glm::dvec2& corner);

}  // namespace marey::recordings
