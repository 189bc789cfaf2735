// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/open_search.h"

#include <utility>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"

#include "recordings/library/index_head.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/library_records.h"

namespace marey::app {
namespace {

library::ClipRows clip_rows(const recordings::RowsFile& file) {
  const recordings::RowsView view = file.rows();
  return {view.values, view.columns, view.begins};
}

}  // namespace

library::SearchRows OpenedSearch::rows() const {
  return {clip_rows(features), clip_rows(windows), clip_rows(wholes)};
}

Result<OpenedSearch> open_search(const std::filesystem::path& library) {
  const std::filesystem::path index = recordings::LibraryPaths(library).index();
  const auto path = recordings::search_file(index, "features.f32");
  if (!path) return path.error();
  const std::filesystem::path folder = path->parent_path();
  auto features = recordings::RowsFile::open(*path, library::kFeatureStride);
  if (!features) return features.error();
  auto windows =
      recordings::RowsFile::open(folder / "windows.f32", library::kWindowFloats);
  if (!windows) return windows.error();
  auto wholes = recordings::RowsFile::open(folder / "wholes.f32", library::kWholeFloats);
  if (!wholes) return wholes.error();
  for (const auto* file : {&*features, &*windows, &*wholes}) {
    if (const Status ok = file->check_values(); !ok) return ok.error();
  }
  const auto clips = recordings::count_library_clips(index);
  if (!clips) return clips.error();
  OpenedSearch out{*std::move(features), *std::move(windows), *std::move(wholes)};
  const library::SearchRows rows = out.rows();
  for (const library::ClipRows& some : {rows.features, rows.windows, rows.wholes}) {
    if (some.clip_count() == *clips) continue;
    return bad_input(
        folder.string(),
        "its rows are of another number of clips than the index has",
        "remove the folder and make it again: marey library build " + library.string());
  }
  return out;
}

}  // namespace marey::app
