// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "library/quality/quality_limits.h"

#include "app/library/page/clip_drawing.h"
#include "app/library/page/clip_listing.h"
#include "app/library/page/clip_neighbours.h"
#include "core/library/clip_record.h"

namespace marey::app {

// Messages to the page of a library (docs/formats/library_page.md): JSON in one line. The
// same data gives the same text. Invalid UTF-8 is replaced.

/// The sender of a request, for the answer.
struct LibraryAsker {
  std::string about;  ///< Type of the request.
  std::string id;     ///< Chosen by the page.
  int revision = 0;   ///< The open index.
};

/// The state of a library.
struct LibraryState {
  int revision = 0;
  std::string name;
  std::string folder;
  int clips = 0;
  int failed = 0;       ///< Sources that gave no clip.
  std::string trouble;  ///< The reason why there is no list; empty: none.
  std::string query;    ///< Expression of the command line.
};

/// A neighbour with the columns that the page shows.
struct ShownNeighbour {
  ClipNeighbour neighbour;
  double start_s = 0.0;  ///< Start of the part, since the first frame.
  double end_s = 0.0;
  std::string trouble;  ///< The reason why its motion is not shown; empty: it is.
};

/// A clip with its motion.
struct ShownClip {
  const ClipRecord& record;
  int number = 0;
  std::string scene;    ///< Scene message of its motion; empty: no motion.
  int frame_step = 1;   ///< Frames of the clip from one frame of the scene to the next.
  std::string trouble;  ///< The reason why there is no motion.
  bool is_mirrored = false;
  double compared_s = 0.0;  ///< Length of the part that was compared.
  std::vector<ShownNeighbour> neighbours;
  std::string neighbour_trouble;
};

[[nodiscard]] std::string library_page_json(const LibraryState& state);
/// `rows`: numbers of the clips that the request asked for.
[[nodiscard]] std::string clips_json(const LibraryAsker& asker,
                                     const ClipListing& listing,
                                     const FoundClips& found,
                                     int offset,
                                     std::span<const int> rows);
/// Returns the points of a drawing: a list of four lists of x and y by turns.
[[nodiscard]] std::string drawing_json(int clip, const ClipDrawing& drawing);
/// Returns the same of a clip without a drawing.
[[nodiscard]] std::string missing_drawing_json(int clip);
/// `drawings`: texts of drawing_json().
[[nodiscard]] std::string drawings_json(const LibraryAsker& asker,
                                        std::span<const std::string> drawings);
[[nodiscard]] std::string shown_clip_json(const LibraryAsker& asker,
                                          const ShownClip& clip,
                                          const ClipListing& listing,
                                          const library::QualityLimits& limits);
/// `file`: the table that a line was added to.
[[nodiscard]] std::string stored_json(const LibraryAsker& asker, const std::string& file);
/// The request belongs to an older index.
[[nodiscard]] std::string outdated_json(const LibraryAsker& asker);
[[nodiscard]] std::string library_error_json(const LibraryAsker& asker,
                                             const std::string& text);

}  // namespace marey::app
