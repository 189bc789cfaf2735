// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_library.h"

#include <utility>

#include "library/export/split_clips.h"

#include "app/library/export/clip_sink.h"
#include "app/library/export/clip_tables.h"
#include "app/library/export/export_folder.h"
#include "app/library/export/export_sheets.h"
#include "app/library/find/clip_motions.h"
#include "core/base/assert.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/atomic_folder.h"
#include "recordings/library/library_index.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

Error nothing_to_export(const ExportOptions& options, const ExportReport& report) {
  if (report.selected > 0) {
    const LeftOutClip& first = report.left_out.front();
    return bad_input(options.library.string(),
                     "none of the " + std::to_string(report.selected) +
                         " selected clips can be exported; the first, " + first.name +
                         ": " + first.reason,
                     "choose another --skeleton or --as");
  }
  if (options.query.empty()) {
    return bad_input(options.library.string(),
                     "the library has no clips",
                     "add sources with marey library add");
  }
  return bad_input("--query", "selects no clip", "try it with marey library query");
}

/// Writes the clips of one layout.
class ClipExport {
 public:
  ClipExport(const ExportOptions& options, const ExportBody& body, const fs::path& folder)
      : options_(options),
        motions_(options.library, OuterLinks::kFollow),
        converter_(options, body),
        sink_(make_clip_sink(options, body, folder)) {}

  /// Adds one clip of the library to the export and to the report.
  Status add(const ClipRecord& record, ExportReport& report) {
    if (options_.format == ExportFormat::kTable) {
      add_record(record, record.frame_count(), report);
      if (options_.adds_mirrored) {
        add_record(
            mirrored_record(record, report.unknown_sides), record.frame_count(), report);
      }
      return Done{};
    }
    auto motion = motions_.read(record);
    if (!motion) return motion.error();
    std::vector<UnknownSide> unknown;
    auto clips = converter_.convert(record, *std::move(motion), unknown);
    if (!clips) return leave_out(record, clips.error(), report);
    for (const ExportedClip& clip : *clips) {
      if (const Status ok = sink_->check(clip); !ok) {
        return leave_out(record, ok.error(), report);
      }
    }
    for (ExportedClip& clip : *clips) {
      if (const Status ok = sink_->add(clip); !ok) return ok;
      const auto frames = static_cast<std::int64_t>(clip.motion.motion.poses.size());
      add_record(std::move(clip.record), frames, report);
    }
    report.unknown_sides.insert(
        report.unknown_sides.end(), unknown.begin(), unknown.end());
    return Done{};
  }

  Status finish() { return sink_->finish(); }

 private:
  static void add_record(ClipRecord record, std::int64_t frames, ExportReport& report) {
    report.clips.push_back(std::move(record));
    report.frames += frames;
  }

  static Status leave_out(const ClipRecord& record,
                          const Error& error,
                          ExportReport& report) {
    report.left_out.push_back({record.clip_id, record.name, error.cause});
    return Done{};
  }

  const ExportOptions& options_;
  ClipMotions motions_;
  ClipConverter converter_;
  std::unique_ptr<ClipSink> sink_;
};

Status write_texts(const ExportReport& report,
                   const ExportOptions& options,
                   const fs::path& folder) {
  std::vector<std::pair<const char*, std::string>> files{
      {"splits.csv", splits_csv(report.clips)},
      {"LICENCES.md", licences_text(report, options)},
      {"DATASHEET.md", datasheet_text(report, options)}};
  if (options.format == ExportFormat::kTable) {
    files.emplace_back("clips.csv", clips_csv(report.clips));
    files.emplace_back("figures.csv", figures_csv(report.clips));
    files.emplace_back("labels.csv", labels_csv(report.clips));
    const Status ok =
        recordings::write_library_index(folder / "library.sqlite", report.clips);
    if (!ok) return ok;
  }
  for (const auto& [file, text] : files) {
    if (const Status ok = recordings::write_file(folder / file, text); !ok) return ok;
  }
  return Done{};
}

}  // namespace

Result<ExportReport> export_library(const ExportOptions& options,
                                    std::vector<ClipRecord> records,
                                    std::span<const int> selected,
                                    const Progress& progress) {
  if (const Status ok = check_outside(options.out, options.library); !ok) {
    return ok.error();
  }
  if (const Status ok = check_export_folder(options.out, options.replaces); !ok) {
    return ok.error();
  }
  const auto body = open_export_body(options.skeleton);
  if (!body) return body.error();
  const auto splits = library::split_clips(records, options.splits, options.split_by);
  std::vector<const ClipRecord*> clips;
  for (const int number : selected) {
    MAREY_ASSERT(number >= 0 && static_cast<std::size_t>(number) < records.size());
    const auto i = static_cast<std::size_t>(number);
    records[i].split = splits[i];
    clips.push_back(&records[i]);
  }
  ExportReport report;
  report.selected = clips.size();
  report.in_library = records.size();
  if (clips.empty()) return nothing_to_export(options, report);
  report.licences = decide_licences(clips, options);
  if (const Status ok = check_licences(report.licences, options); !ok) return ok.error();
  auto folder = recordings::AtomicFolder::create(options.out);
  if (!folder) return folder.error();
  ClipExport output(options, *body, folder->partial());
  for (std::size_t i = 0; i < clips.size(); ++i) {
    if (const Status ok = output.add(*clips[i], report); !ok) return ok.error();
    if (progress) progress(static_cast<int>(i + 1), static_cast<int>(clips.size()));
  }
  if (report.clips.empty()) return nothing_to_export(options, report);
  if (const Status ok = output.finish(); !ok) return ok.error();
  if (const Status ok = write_texts(report, options, folder->partial()); !ok) {
    return ok.error();
  }
  if (const Status ok = write_manifest(folder->partial()); !ok) return ok.error();
  // The user may have added files meanwhile, which a replacement would remove.
  if (const Status ok = check_export_folder(options.out, options.replaces); !ok) {
    return ok.error();
  }
  if (const Status ok = folder->commit(); !ok) return ok.error();
  return report;
}

}  // namespace marey::app
