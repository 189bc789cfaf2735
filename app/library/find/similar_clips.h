// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/library/find/open_search.h"
#include "app/library/find/similar_query.h"
#include "core/base/result.h"
#include "recordings/library/library_records.h"

namespace marey::app {

struct SimilarClipsOptions {
  int top = 10;
  bool mirror = false;       ///< Searches for the mirror image.
  bool exact = false;        ///< Compares every clip exactly.
  bool whole_clips = false;  ///< Compares whole clips, not parts of them.
  /// Length of the middle of a longer query that is used [s]; nullopt: 2 s, or all of it
  /// for a query with a range or whole clips.
  std::optional<double> length_s;
  std::string query;  ///< Expression for the clips that are searched; empty: all.
};

/// A part of a clip that is similar to the query.
struct SimilarClip {
  recordings::ClipSummary clip;
  double start_s = 0.0;  ///< Since the first frame of the clip.
  double end_s = 0.0;
  double distance = 0.0;  ///< SimilarMotion::distance.
};

struct SimilarClips {
  std::vector<SimilarClip> clips;    ///< Ascending by distance.
  std::vector<std::string> remarks;  ///< ClipQuery::remarks.
};

/// Finds the clips of a library that are most similar to a query
/// (library/search/find_similar.h). The query's own clip is left out. Cost: that of
/// find_similar(), plus about 1 ms for each part of the result.
/// Errors: those of run_clip_query(); a damaged index.
[[nodiscard]] Result<SimilarClips> find_similar_clips(
    const std::filesystem::path& library,
    const SimilarQuery& query,
    const OpenedSearch& search,
    const SimilarClipsOptions& options = {});

}  // namespace marey::app
