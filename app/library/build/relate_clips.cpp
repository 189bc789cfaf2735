// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/relate_clips.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <thread>

#include "library/duplicates/find_duplicates.h"
#include "library/export/split_clips.h"
#include "library/features/body_features.h"
#include "library/quality/contradicted_sizes.h"
#include "library/search/clip_rows.h"

#include "app/library/labels/apply_labels.h"
#include "app/library/labels/apply_verdicts.h"
#include "app/library/labels/library_labels.h"
#include "core/finding.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/rows_file.h"

namespace marey::app {
namespace {

/// Adds the labels of people, and their corrections of verdicts.
Status add_people_labels(const BuildInputs& inputs,
                         std::vector<ClipRecord>& records,
                         std::vector<std::string>& remarks) {
  const auto labels = read_library_labels(inputs.library);
  if (!labels) return labels.error();
  for (const auto& unused :
       {apply_labels(*labels, records), apply_library_verdicts(*labels, records)}) {
    for (const Finding& finding : unused_label_findings(unused)) {
      remarks.push_back(finding.message());
    }
  }
  return Done{};
}

Status add_duplicates(const BuildInputs& inputs,
                      const std::string& search,
                      std::vector<ClipRecord>& records) {
  const auto file = recordings::RowsFile::open(
      recordings::LibraryPaths(inputs.library).search(search) / "features.f32",
      library::kFeatureStride);
  if (!file) return file.error();
  const recordings::RowsView rows = file->rows();
  const std::size_t threads = std::thread::hardware_concurrency();
  const auto duplicates =
      library::find_duplicates({rows.values, rows.columns, rows.begins},
                               inputs.settings.duplicates,
                               threads == 0 ? 1 : threads);
  for (const library::DuplicateClip& found : duplicates) {
    ClipRecord& record = records[static_cast<std::size_t>(found.clip)];
    const std::string& original =
        records[static_cast<std::size_t>(found.original)].clip_id;
    (found.is_mirrored ? record.mirror_of : record.duplicate_of) = original;
  }
  return Done{};
}

/// Marks clips whose body has another size than in the other clips of its person.
void add_sizes(std::vector<ClipRecord>& records) {
  std::vector<library::ClipBody> bodies;
  bodies.reserve(records.size());
  for (const ClipRecord& record : records) bodies.push_back(library::body_of(record));
  for (const library::ContradictedSize& size : library::find_contradicted_sizes(bodies)) {
    ClipRecord& record = records[size.clip];
    record.problems.insert(record.problems.begin(),
                           library::problem_of(size, record.frame_count()));
    record.figures.push_back(
        {"size_ratio", size.ratio, Verdict::kWarn, "", std::nullopt});
    std::ranges::sort(record.figures, {}, &ClipFigure::name);
    record.quality = std::max(record.quality, Verdict::kWarn);
  }
}

void add_splits(const BuildInputs& inputs, std::vector<ClipRecord>& records) {
  const auto splits =
      library::split_clips(records, inputs.settings.splits, library::SplitBy::kSubject);
  for (std::size_t i = 0; i < records.size(); ++i) records[i].split = splits[i];
}

}  // namespace

Status relate_clips(const BuildInputs& inputs,
                    const std::string& search,
                    std::vector<ClipRecord>& records,
                    std::vector<std::string>& remarks) {
  add_sizes(records);  // Before the corrections of people, which it must not undo.
  const Status labelled = add_people_labels(inputs, records, remarks);
  if (!labelled) return labelled;
  if (const Status ok = add_duplicates(inputs, search, records); !ok) return ok;
  add_splits(inputs, records);
  return Done{};
}

}  // namespace marey::app
