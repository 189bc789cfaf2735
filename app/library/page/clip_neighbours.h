// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/library/find/open_search.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// A clip that is similar to another one, and the part of it that is.
struct ClipNeighbour {
  int clip = 0;
  double distance = 0.0;  ///< As library::SimilarMotion::distance.
  int first_row = 0;      ///< The part: rows of 0.1 s from the clip's first instant on.
  int last_row = 0;
};

/// The neighbours of a clip.
struct FoundNeighbours {
  std::vector<ClipNeighbour> clips;  ///< Ascending by distance.
  /// Rows of the clip that were compared, from its first one on.
  int compared_rows = 0;
};

/// Finds similar clips in the search files of a library, which stay mapped.
class ClipNeighbours {
 public:
  /// Errors (kBadInput): those of open_search(); the index has another number of clips
  /// now than `clip_count`.
  [[nodiscard]] static Result<ClipNeighbours> open(const std::filesystem::path& library,
                                                   int clip_count);

  /// Returns the most similar other clips. The query is the clip's beginning, at most 8 s
  /// of it. `is_mirrored`: searches for its mirror image. Cost: that of
  /// library::find_similar(). Precondition: the clip exists.
  [[nodiscard]] FoundNeighbours find(int clip, bool is_mirrored, int count) const;

  static constexpr int kMaxQueryRows = 81;

 private:
  explicit ClipNeighbours(OpenedSearch search) : search_(std::move(search)) {}

  OpenedSearch search_;
};

/// Returns the time of the first row of a clip since its first frame: rows are at
/// multiples of 0.1 s of the source's time. 0 to 0.1. [s]
[[nodiscard]] double first_row_s(int first_frame, double rate_hz);

}  // namespace marey::app
