// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/collect_records.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "library/features/feature_span.h"

#include "app/library/sources/source_kind.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/source_stage.h"

namespace marey::app {
namespace {

using recordings::object_path;

std::optional<std::vector<ClipRecord>> read_clips(const BuildInputs& inputs,
                                                  const std::string& key) {
  const auto text = recordings::read_file(inputs.library / object_path(key, ".json"));
  if (!text) return std::nullopt;
  return recordings::parse_clip_records(*text);
}

/// Returns the name of a clip for people: that of its file, its body, its number.
std::string clip_name(const SourceFile& file,
                      const ClipRecord& record,
                      std::size_t number,
                      std::size_t count) {
  std::string out = source_stem(file.name, file.kind);
  if (!record.body.empty()) out += "#" + record.body;
  if (count > 1) out += format_text(".%03zu", number + 1);
  return out;
}

Provenance provenance_of(const LibrarySource& source,
                         const SourceFile& file,
                         const std::optional<IndexEntry>& entry,
                         const Provenance& found) {
  Provenance out = found;
  out.path = file.name;
  out.kind = file.kind;
  out.licence = source.licence.empty() ? "unknown" : source.licence;
  out.origin = source.origin;
  out.commit = source.commit;
  out.attribution = source.attribution;
  if (entry && !entry->subject.empty()) out.subject = entry->subject;
  const std::string stated = subject_of(file, source);
  if (!stated.empty()) out.subject = stated;
  return out;
}

void add_labels(std::vector<ClipLabel> labels, ClipRecord& record) {
  for (ClipLabel& label : labels) record.labels.push_back(std::move(label));
}

void sort_labels(ClipRecord& record) {
  std::ranges::sort(record.labels, [](const ClipLabel& a, const ClipLabel& b) {
    return std::tie(a.start_s, a.text, a.end_s, a.by) <
           std::tie(b.start_s, b.text, b.end_s, b.by);
  });
}

/// Counts the records of each body: numbers of segments are counted in their body.
std::map<std::string, std::size_t> count_bodies(const std::vector<ClipRecord>& records) {
  std::map<std::string, std::size_t> out;
  for (const ClipRecord& record : records) ++out[record.body];
  return out;
}

void add_records(const BuildInputs& inputs,
                 const SourceFile& file,
                 const SourceOutcome& outcome,
                 std::vector<ClipRecord> records,
                 std::set<std::string>& ids,
                 CollectedRecords& out) {
  const LibrarySource& source = inputs.settings.sources[file.source];
  const auto entry = inputs.find_in_table(file);
  const auto counts = count_bodies(records);
  std::map<std::string, std::size_t> numbers;
  std::size_t row = 0;
  for (ClipRecord& record : records) {
    record.name = clip_name(file, record, numbers[record.body]++, counts.at(record.body));
    record.provenance = provenance_of(source, file, entry, record.provenance);
    add_labels(labels_of_name(file, source, record.duration_s()), record);
    if (entry) add_labels(labels_of_index(*entry, record.duration_s()), record);
    sort_labels(record);
    const std::size_t first_row = row;
    row += static_cast<std::size_t>(
        library::feature_span(record.first_frame, record.last_frame, record.rate_hz)
            .count);
    if (!ids.insert(record.clip_id).second) {
      // Bodies of one name; an index needs different ids.
      out.remarks.push_back(file.name + ": two of its clips are the same; one is kept");
      continue;
    }
    out.feature_keys.push_back(outcome.clips_key);
    out.first_rows.push_back(first_row);
    out.records.push_back(std::move(record));
  }
}

}  // namespace

CollectedRecords collect_records(const BuildInputs& inputs,
                                 const std::vector<SourceFile>& sources,
                                 const std::vector<SourceOutcome>& outcomes) {
  CollectedRecords out;
  std::map<std::string, std::size_t> first_with;
  std::set<std::string> ids;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const SourceOutcome& outcome = outcomes[i];
    if (outcome.clips_key.empty()) continue;
    const auto [known, is_new] = first_with.emplace(outcome.source_id, i);
    if (!is_new) {
      const SourceFile& first = sources[known->second];
      std::string remark = sources[i].name + " has the same bytes as " + first.name +
                           ", and gave no other clip";
      const auto& settings = inputs.settings.sources;
      if (settings[sources[i].source].licence != settings[first.source].licence) {
        remark += "; the licence of " + first.name + " counts";
      }
      out.remarks.push_back(std::move(remark));
      continue;
    }
    auto records = read_clips(inputs, outcome.clips_key);
    if (!records) {
      out.damaged.push_back(i);
      continue;
    }
    if (records->empty()) {
      out.remarks.push_back(sources[i].name +
                            ": no part of its motions became a clip; see [segment] in "
                            "library.toml");
    }
    add_records(inputs, sources[i], outcome, std::move(*records), ids, out);
  }
  return out;
}

}  // namespace marey::app
