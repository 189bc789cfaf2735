// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/build_inputs.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "library/quality/quality_limits.h"

#include "app/library/labels/label_targets.h"
#include "app/library/labels/settings_digest.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_file.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

// Versions of the stages. A change of a stage's results needs a new one, so that existing
// libraries are built again: of reading, normal form and floor; of segments, labels,
// features and figures. Limits of figures are a part of the key.
constexpr int kMotionStage = 1;
constexpr int kClipsStage = 1;

/// Reads the labels if motions are divided by them.
Status read_labels_of(BuildInputs& out) {
  if (out.settings.segment != SegmentBy::kLabels) return Done{};
  auto labels = read_library_labels(out.library);
  if (!labels) return labels.error();
  out.segment_labels = std::move(*labels);
  return Done{};
}

/// Reads the index tables of all sources.
Status read_tables(BuildInputs& out) {
  for (const LibrarySource& source : out.settings.sources) {
    auto& table = out.tables.emplace_back();
    if (source.index.empty()) continue;
    const fs::path path = out.library / source.index;  // Stays if it is absolute.
    const auto text = recordings::read_file(path);
    if (!text) return text.error();
    auto parsed = IndexTable::parse(*text, path.string());
    if (!parsed) return parsed.error();
    table = std::move(*parsed);
  }
  return Done{};
}

/// Checks that limits are of figures that exist.
Status check_limits(const std::vector<QualityLimit>& limits, const std::string& file) {
  std::vector<std::string_view> known;
  for (const library::FigureRule& rule : library::figure_rules()) {
    if (rule.is_judged) known.push_back(rule.figure);
  }
  for (const QualityLimit& limit : limits) {
    if (std::ranges::find(known, limit.figure) != known.end()) continue;
    return bad_input(file + ": [quality]",
                     in_quotes(limit.figure) + " is no figure with limits",
                     suggestion(limit.figure, std::span<const std::string_view>(known)));
  }
  return Done{};
}

/// Returns all labels that divide the motions of a source. Sources with the same bytes
/// may have other labels, and then have other clips.
std::string labels_text(const BuildInputs& inputs, const SourceFile& file) {
  std::vector<recordings::LabelRow> rows = inputs.labels_of(file);
  for (recordings::LabelRow& row : rows) row.target.clear();
  return recordings::sha256(recordings::labels_text(rows));
}

/// A number that every value of double has another text for.
std::string exact_text(double value) {
  return format_text("%.17g", value);
}

}  // namespace

std::vector<recordings::LabelRow> BuildInputs::labels_of(const SourceFile& file) const {
  std::vector<recordings::LabelRow> out;
  if (!segment_labels) return out;
  for (const LabelFile& table : segment_labels->files) {
    std::ranges::copy_if(table.rows, std::back_inserter(out), [&](const auto& row) {
      return row.target == file.name;
    });
  }
  return out;
}

void name_label_sources(BuildInputs& inputs, const std::vector<std::string>& names) {
  if (!inputs.segment_labels) return;
  std::vector<ClipRecord> sources(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    sources[i].provenance.path = names[i];
    sources[i].clip_id = "source " + std::to_string(i);
  }
  const LabelTargets targets(sources);
  for (LabelFile& file : inputs.segment_labels->files) {
    std::vector<recordings::LabelRow> kept;
    for (recordings::LabelRow& row : file.rows) {
      LabelTarget target = targets.find(row.target);
      if (target.kind != LabelTarget::Kind::kSource) continue;
      row.target = std::move(target.name);
      kept.push_back(std::move(row));
    }
    file.rows = std::move(kept);
  }
}

Result<BuildInputs> read_build_inputs(const fs::path& library) {
  std::error_code failed;
  BuildInputs out;
  out.library = fs::absolute(library, failed).lexically_normal();
  const fs::path file = recordings::LibraryPaths(out.library).settings();
  if (!fs::exists(file, failed)) {
    return bad_input(library.string(),
                     "there is no library.toml in this folder",
                     "make a library of a folder with motions: marey library add LIB "
                     "FOLDER --licence SPDX --source TEXT");
  }
  const auto text = recordings::read_file(file);
  if (!text) return text.error();
  auto settings = recordings::parse_library(*text, file.string());
  if (!settings) return settings.error();
  if (const Status ok = check_limits(settings->limits, file.string()); !ok) {
    return ok.error();
  }
  out.settings = std::move(*settings);
  if (const Status ok = read_tables(out); !ok) return ok.error();
  if (const Status ok = read_labels_of(out); !ok) return ok.error();
  auto digest = settings_digest(out.library, out.settings);
  if (!digest) return digest.error();
  out.digest = std::move(*digest);
  return out;
}

std::optional<IndexEntry> BuildInputs::find_in_table(const SourceFile& file) const {
  const auto& table = tables[file.source];
  return table ? table->find(file) : std::nullopt;
}

SourceKeys keys_of(const BuildInputs& inputs,
                   const SourceFile& file,
                   const std::string& source_id) {
  const LibrarySettings& settings = inputs.settings;
  const LibrarySource& source = settings.sources[file.source];
  std::string reading = "kind " + file.kind;
  reading += " clean " + std::to_string(static_cast<int>(settings.clean));
  if (source.rate_hz) reading += " option " + exact_text(*source.rate_hz);
  const auto entry = inputs.find_in_table(file);
  if (entry && entry->rate_hz) {
    reading += " table " + exact_text(*entry->rate_hz);
    if (entry->duration_s) reading += " of " + exact_text(*entry->duration_s) + " s";
    reading += " " + entry->evidence;
  }
  std::string clips = "segment " + std::to_string(static_cast<int>(settings.segment));
  if (inputs.segment_labels) clips += " " + labels_text(inputs, file);
  for (const library::FigureRule& rule : library::figure_rules()) {
    clips += " " + std::string(rule.figure) + " " + exact_text(rule.warn) + " " +
             exact_text(rule.fail);
  }
  for (const QualityLimit& limit : settings.limits) {
    clips +=
        " " + limit.figure + " " + exact_text(limit.warn) + " " + exact_text(limit.fail);
  }
  SourceKeys out;
  out.motion = recordings::stage_key(source_id, "motion", kMotionStage, reading, "");
  out.clips = recordings::stage_key(source_id, "clips", kClipsStage, clips, out.motion);
  return out;
}

}  // namespace marey::app
