// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/similar_clips.h"

#include <algorithm>
#include <utility>

#include "library/features/body_features.h"
#include "library/features/feature_span.h"

#include "app/library/find/query_clips.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Middle of a query that is used unless a length is stated. [s]
constexpr double kUsualLength_s = 2.0;

/// Sets the times of a part from its rows and the record of its clip.
void set_times(const library::SimilarMotion& found,
               const ClipRecord& record,
               SimilarClip& out) {
  const double first_s =
      record.rate_hz > 0.0
          ? library::feature_span(record.first_frame, record.last_frame, record.rate_hz)
                .start_s
          : 0.0;
  const double duration_s = record.duration_s();
  const auto time_of = [&](int row) {
    return std::min(first_s + row / library::kFeatureRate_hz, duration_s);
  };
  out.start_s = time_of(found.first_row);
  out.end_s = time_of(found.last_row);
}

}  // namespace

Result<SimilarClips> find_similar_clips(const fs::path& library,
                                        const SimilarQuery& query,
                                        const OpenedSearch& search,
                                        const SimilarClipsOptions& options) {
  SimilarClips out;
  const library::SearchRows rows = search.rows();
  library::FindSimilarOptions find;
  find.top = options.top;
  find.mirror = options.mirror;
  find.exact = options.exact;
  find.whole_clips = options.whole_clips;
  find.length_s = options.length_s;
  if (!find.length_s && !query.has_range && !options.whole_clips) {
    find.length_s = kUsualLength_s;
  }
  find.skipped_clip = query.clip;
  std::vector<bool> searched;
  if (!options.query.empty()) {
    auto selected = run_clip_query(library, options.query);
    if (!selected) return selected.error();
    searched.resize(static_cast<std::size_t>(rows.features.clip_count()));
    for (const int number : selected->numbers) {
      if (number < rows.features.clip_count()) {
        searched[static_cast<std::size_t>(number)] = true;
      }
    }
    find.searched = &searched;
    out.remarks = std::move((*selected).remarks);
  }
  const auto found = library::find_similar(query.rows, rows, find);
  std::vector<int> numbers;
  for (const library::SimilarMotion& one : found) numbers.push_back(one.clip);
  const fs::path index = recordings::LibraryPaths(library).index();
  auto clips = recordings::read_clip_summaries(index, numbers);
  if (!clips) return clips.error();
  const auto records = recordings::read_library_records(index, numbers);
  if (!records) return records.error();
  for (std::size_t k = 0; k < found.size(); ++k) {
    SimilarClip& one = out.clips.emplace_back();
    one.clip = std::move((*clips)[k]);
    one.distance = found[k].distance;
    set_times(found[k], (*records)[k], one);
  }
  return out;
}

}  // namespace marey::app
