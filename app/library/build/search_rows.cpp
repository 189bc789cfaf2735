// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/search_rows.h"

#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/features/feature_span.h"

#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/rows_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::RowsFile;
using recordings::RowsFileWriter;

/// The three files of rows, written together.
struct SearchWriters {
  RowsFileWriter features;
  RowsFileWriter windows;
  RowsFileWriter wholes;

  void add_clip(std::span<const float> rows) {
    features.add_clip(rows);
    windows.add_clip(library::feature_windows(rows));
    wholes.add_clip(library::whole_clip_row(rows));
  }
};

Result<SearchWriters> create_writers(const fs::path& folder) {
  auto features =
      RowsFileWriter::create(folder / "features.f32", library::kFeatureStride);
  if (!features) return features.error();
  auto windows = RowsFileWriter::create(folder / "windows.f32", library::kWindowFloats);
  if (!windows) return windows.error();
  auto wholes = RowsFileWriter::create(folder / "wholes.f32", library::kWholeFloats);
  if (!wholes) return wholes.error();
  return SearchWriters{std::move(*features), std::move(*windows), std::move(*wholes)};
}

bool has_rows(const fs::path& folder) {
  const auto is_whole = [&](const char* name, std::size_t columns) {
    const auto file = RowsFile::open(folder / name, columns);
    return file && file->check_values();
  };
  return is_whole("features.f32", library::kFeatureStride) &&
         is_whole("windows.f32", library::kWindowFloats) &&
         is_whole("wholes.f32", library::kWholeFloats);
}

}  // namespace

std::string search_folder_name(const CollectedRecords& clips) {
  constexpr std::size_t kDigits = 16;
  std::string text;
  for (std::size_t i = 0; i < clips.records.size(); ++i) {
    text += clips.records[i].clip_id + " " + clips.feature_keys[i] + "\n";
  }
  return recordings::sha256(text).substr(0, kDigits);
}

bool has_search_rows(const BuildInputs& inputs, const std::string& name) {
  return !name.empty() && has_rows(recordings::LibraryPaths(inputs.library).search(name));
}

Status write_search_rows(const BuildInputs& inputs,
                         const CollectedRecords& clips,
                         const std::string& name,
                         std::vector<std::size_t>& damaged) {
  const fs::path folder = recordings::LibraryPaths(inputs.library).search(name);
  if (has_search_rows(inputs, name)) return Done{};
  auto writers = create_writers(folder);
  if (!writers) return writers.error();
  std::optional<RowsFile> object;
  std::optional<Error> failure;
  std::string key;
  for (std::size_t i = 0; i < clips.records.size(); ++i) {
    const fs::path path =
        inputs.library / recordings::object_path(clips.feature_keys[i], ".f32");
    if (clips.feature_keys[i] != key) {
      key = clips.feature_keys[i];
      object.reset();
      auto opened = RowsFile::open(path, library::kFeatureStride);
      const Status ok = opened ? opened->check_values() : Status(opened.error());
      if (ok) {
        object.emplace(std::move(*opened));
      } else {
        damaged.push_back(i);
        failure = ok.error();
      }
    }
    // All damaged objects are found, so that one import makes all of them again.
    if (!object) continue;
    const ClipRecord& record = clips.records[i];
    const auto count = static_cast<std::size_t>(
        library::feature_span(record.first_frame, record.last_frame, record.rate_hz)
            .count);
    const std::span<const float> values = object->rows().values;
    const std::size_t first = clips.first_rows[i] * library::kFeatureStride;
    const std::size_t floats = count * library::kFeatureStride;
    if (first + floats > values.size()) {
      damaged.push_back(i);
      object.reset();
      failure = bad_input(path.string(),
                          "the features of the clip are incomplete",
                          "delete the file, and build the library again");
      continue;
    }
    writers->add_clip(values.subspan(first, floats));
  }
  if (failure) return *failure;
  if (const Status ok = writers->features.commit(); !ok) return ok;
  if (const Status ok = writers->windows.commit(); !ok) return ok;
  return writers->wholes.commit();
}

void remove_old_search_rows(const BuildInputs& inputs,
                            const std::string& current,
                            const std::string& before) {
  std::error_code failed;
  std::vector<fs::path> old;
  const fs::path search = recordings::LibraryPaths(inputs.library).search();
  for (fs::directory_iterator at(search, failed), end; !failed && at != end;
       at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (name != current && name != before) old.push_back(at->path());
  }
  for (const fs::path& folder : old) fs::remove_all(folder, failed);
}

}  // namespace marey::app
