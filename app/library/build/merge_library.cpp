// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/merge_library.h"

#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

#include "app/library/build/collect_records.h"
#include "app/library/build/failed_sources.h"
#include "app/library/build/relate_clips.h"
#include "app/library/build/search_rows.h"
#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_index.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/version_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::IndexHead;
using recordings::LibraryPaths;
using recordings::OnDisk;

/// Returns a digest of everything that the merge depends on.
std::string inputs_digest(const BuildInputs& inputs,
                          const std::vector<SourceFile>& sources,
                          const std::vector<SourceOutcome>& outcomes) {
  // A change of the merge's results needs a new version here.
  std::string text = "merge 1 " + inputs.digest + "\n";
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const SourceOutcome& outcome = outcomes[i];
    text += outcome.name + "\n" + outcome.source_id + " " + outcome.clips_key + "\n";
    if (outcome.failure) text += outcome.failure->message() + "\n";
  }
  return recordings::sha256(text);
}

/// Returns the library's state if nothing has changed since it was merged.
std::optional<MergedLibrary> find_merged(const BuildInputs& inputs,
                                         const IndexHead& head,
                                         const std::string& digest) {
  const LibraryPaths paths(inputs.library);
  std::error_code failed;
  if (head.inputs != digest || !has_search_rows(inputs, head.search) ||
      !fs::is_regular_file(recordings::version_path(inputs.library, head.version),
                           failed)) {
    return std::nullopt;
  }
  MergedLibrary out;
  out.head = head;
  std::istringstream lines(head.remarks);
  for (std::string line; std::getline(lines, line);) out.remarks.push_back(line);
  return out;
}

void count_clips(const std::vector<ClipRecord>& records, IndexHead& out) {
  out.clips = static_cast<std::int64_t>(records.size());
  for (const ClipRecord& record : records) {
    if (record.quality == Verdict::kWarn) ++out.warned;
    if (record.quality == Verdict::kFail) ++out.failed;
    if (!record.duplicate_of.empty()) ++out.duplicates;
    out.seconds += record.duration_s();
  }
}

/// Writes the version of these records, unless it is the last one.
Status write_version(const BuildInputs& inputs,
                     const std::vector<ClipRecord>& records,
                     MergedLibrary& out) {
  std::vector<recordings::VersionLine> lines;
  lines.reserve(records.size());
  for (const ClipRecord& record : records) {
    lines.push_back(recordings::version_line(record));
  }
  const std::string text = recordings::version_text(std::move(lines));
  out.head.version_name = recordings::sha256(text);
  const auto versions = recordings::list_versions(inputs.library);
  if (!versions.empty()) {
    const auto last = recordings::read_file(versions.back().path);
    out.head.version = versions.back().number;
    if (last && *last == text) return Done{};
  }
  ++out.head.version;
  out.is_new_version = true;
  return recordings::write_file(
      recordings::version_path(inputs.library, out.head.version), text, OnDisk::kNow);
}

/// Removes the objects of a source's clips, so that they are made again.
void remove_objects(const BuildInputs& inputs, const std::string& clips_key) {
  std::error_code ignored;
  for (const char* extension : {".json", ".f32"}) {
    fs::remove(inputs.library / recordings::object_path(clips_key, extension), ignored);
  }
}

Error damaged_objects() {
  return bad_input("objects",
                   "objects of the library are damaged",
                   "build the library again: marey library build");
}

/// Returns the sources whose objects are damaged, after removing them.
void remove_damaged(const BuildInputs& inputs,
                    const std::vector<SourceOutcome>& outcomes,
                    const CollectedRecords& clips,
                    const std::vector<std::size_t>& damaged_clips,
                    std::vector<std::size_t>& damaged) {
  damaged = clips.damaged;
  for (const std::size_t clip : damaged_clips) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].clips_key == clips.feature_keys[clip]) {
        damaged.push_back(i);
        break;
      }
    }
  }
  for (const std::size_t source : damaged) {
    remove_objects(inputs, outcomes[source].clips_key);
  }
}

}  // namespace

Result<MergedLibrary> merge_library(const BuildInputs& inputs,
                                    const std::vector<SourceFile>& sources,
                                    const std::vector<SourceOutcome>& outcomes,
                                    std::vector<std::size_t>& damaged) {
  const LibraryPaths paths(inputs.library);
  auto old = recordings::read_index_head(paths.index());
  if (old) {
    const Status whole = recordings::check_library_index(paths.index());
    if (!whole) old = whole.error();
  }
  const IndexHead before = old ? *old : IndexHead{};
  IndexHead head;
  head.inputs = inputs_digest(inputs, sources, outcomes);
  head.settings = inputs.digest;
  if (auto merged = find_merged(inputs, before, head.inputs)) return std::move(*merged);
  CollectedRecords clips = collect_records(inputs, sources, outcomes);
  head.search = search_folder_name(clips);
  std::vector<std::size_t> damaged_clips;
  if (clips.damaged.empty()) {
    const Status ok = write_search_rows(inputs, clips, head.search, damaged_clips);
    if (!ok && damaged_clips.empty()) return ok.error();
  }
  if (!clips.damaged.empty() || !damaged_clips.empty()) {
    remove_damaged(inputs, outcomes, clips, damaged_clips, damaged);
    return damaged_objects();
  }
  MergedLibrary out;
  out.head = head;
  std::error_code failed;
  for (const SourceFile& source : sources) {
    // Shards may have been worked on long ago.
    if (fs::exists(source.path, failed)) continue;
    out.remarks.push_back(source.name + ": the file is gone; its clips are from before");
  }
  if (!old && fs::exists(paths.index(), failed)) {
    out.remarks.push_back(old.error().where + ": " + old.error().cause +
                          "; the index was made again");
  }
  const Status related = relate_clips(inputs, head.search, clips.records, clips.remarks);
  if (!related) return related.error();
  for (const std::string& remark : clips.remarks) {
    out.head.remarks += printable(remark) + "\n";
    out.remarks.push_back(remark);
  }
  count_clips(clips.records, out.head);
  if (const Status ok = write_failed_sources(inputs, outcomes); !ok) return ok.error();
  if (const Status ok = write_version(inputs, clips.records, out); !ok) return ok.error();
  const Status ok =
      recordings::write_library_index(paths.index(), clips.records, out.head);
  if (!ok) return ok.error();
  remove_old_search_rows(inputs, head.search, before.search);
  return out;
}

}  // namespace marey::app
