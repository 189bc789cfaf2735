// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "recordings/library/rows_file.h"

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
  /// Errors (kBadInput): those of recordings::RowsFile::open(); the files have another
  /// number of clips than the index, so that they belong to another build.
  [[nodiscard]] static Result<ClipNeighbours> open(const std::filesystem::path& library,
                                                   int clip_count);

  /// Returns the most similar other clips. The query is the clip's beginning, at most 8 s
  /// of it. `is_mirrored`: searches for its mirror image. Cost: that of
  /// library::find_similar(). Precondition: the clip exists.
  [[nodiscard]] FoundNeighbours find(int clip, bool is_mirrored, int count) const;

  static constexpr int kMaxQueryRows = 81;

 private:
  ClipNeighbours(recordings::RowsFile features,
                 recordings::RowsFile windows,
                 recordings::RowsFile wholes)
      : features_(std::move(features)),
        windows_(std::move(windows)),
        wholes_(std::move(wholes)) {}

  recordings::RowsFile features_;
  recordings::RowsFile windows_;
  recordings::RowsFile wholes_;
};

/// Returns the time of the first row of a clip since its first frame: rows are at
/// multiples of 0.1 s of the source's time. 0 to 0.1. [s]
[[nodiscard]] double first_row_s(int first_frame, double rate_hz);

}  // namespace marey::app
