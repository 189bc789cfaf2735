// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_sheets.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "app/shell/version.h"
#include "core/base/format_text.h"
#include "core/base/lower_case.h"
#include "core/base/printable.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/library/index_head.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

struct ClipCount {
  std::size_t clips = 0;
  double seconds = 0.0;

  void add(const ClipRecord& clip) {
    ++clips;
    seconds += clip.duration_s();
  }
};

using Counts = std::map<std::string, ClipCount>;

std::string hours(double seconds) {
  std::string text;
  recordings::append_fixed(text, seconds / 3600.0, 3);
  return text;
}

/// Returns a text of one line for a table of Markdown.
std::string in_cell(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) {
    if (c == '|') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out;
}

std::string table_of(const char* head, const Counts& counts) {
  std::string text = "| " + std::string(head) + " | clips | hours |\n|---|---|---|\n";
  for (const auto& [word, count] : counts) {
    text += "| " + in_cell(word) + " | " + std::to_string(count.clips) + " | " +
            hours(count.seconds) + " |\n";
  }
  return text + "\n";
}

std::string or_none(const std::string& text) {
  return text.empty() ? "(none)" : text;
}

std::string rate_word(double rate_hz) {
  std::string text;
  recordings::append_exact(text, rate_hz);
  return text + " Hz";
}

template <class Word>
Counts count_by(const ExportReport& report, const Word& word) {
  Counts out;
  for (const ClipRecord& clip : report.clips) out[or_none(word(clip))].add(clip);
  return out;
}

/// Counts the clips with each label, without labels by marey itself.
std::string labels_of(const ExportReport& report) {
  constexpr std::size_t kMaxLabels = 50;
  Counts counts;
  for (const ClipRecord& clip : report.clips) {
    std::set<std::string> words;
    for (const ClipLabel& label : clip.labels) {
      if (label.by != "marey") words.insert(label.text);
    }
    for (const std::string& word : words) counts[word].add(clip);
  }
  if (counts.empty()) return "No labels by people.\n\n";
  std::vector<std::pair<std::string, ClipCount>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) {
    return a.second.clips > b.second.clips;
  });
  std::string note;
  if (sorted.size() > kMaxLabels) {
    note = "The " + std::to_string(kMaxLabels) + " most frequent of " +
           std::to_string(sorted.size()) + " labels by people:\n\n";
    sorted.resize(kMaxLabels);
  }
  std::string text = note + "| label | clips | hours of these clips |\n|---|---|---|\n";
  for (const auto& [word, count] : sorted) {
    text += "| " + in_cell(word) + " | " + std::to_string(count.clips) + " | " +
            hours(count.seconds) + " |\n";
  }
  return text + "\n";
}

std::string settings_of(const ExportOptions& options) {
  std::string text = "| setting | value |\n|---|---|\n";
  const auto add = [&](const char* key, const std::string& value) {
    text += "| " + std::string(key) + " | " + in_cell(value) + " |\n";
  };
  add("layout", std::string(name(options.format)));
  add("query", options.query.empty() ? "all clips" : options.query);
  const fs::path skeleton(options.skeleton);
  add("skeleton",
      options.skeleton == "own" ? "own: each clip's body" : skeleton.filename().string());
  add("rate",
      options.rate_hz ? rate_word(*options.rate_hz) + ", resampled" : "each clip's own");
  add("mirrored copies", options.adds_mirrored ? "yes" : "no");
  add("first frame",
      options.starts_at_origin ? "over the origin, facing +Z" : "as captured");
  std::string splits;
  for (const auto& [split, share] : options.splits) {
    if (!splits.empty()) splits += ", ";
    splits += split + format_text(" %g %%", 100.0 * share);
  }
  const bool by_subject = options.split_by == library::SplitBy::kSubject;
  add("splits", splits + (by_subject ? ", by subject" : ", by clip"));
  return text + "\n";
}

std::string left_out_of(const ExportReport& report) {
  std::string text = "## What was left out\n\n";
  const std::size_t unselected = report.in_library - report.selected;
  text += std::to_string(unselected) + " of " + std::to_string(report.in_library) +
          " clips of the library were not selected by the query.\n\n";
  if (report.left_out.empty()) {
    text += "No selected clip was left out.\n\n";
  } else {
    text += std::to_string(report.left_out.size()) +
            " selected clips were left out:\n\n| clip | name | reason |\n|---|---|---|\n";
    for (const LeftOutClip& clip : report.left_out) {
      text += "| " + clip.clip_id + " | " + in_cell(clip.name) + " | " +
              in_cell(clip.reason) + " |\n";
    }
    text += "\n";
  }
  if (!report.unknown_sides.empty()) {
    text +=
        "Labels without a known other side, not in the mirrored copies:\n\n"
        "| label | clips |\n|---|---|\n";
    std::map<std::string, std::set<std::string>> labels;
    for (const auto& [clip, label] : report.unknown_sides) labels[label].insert(clip);
    for (const auto& [label, clips] : labels) {
      text += "| " + in_cell(label) + " | " + std::to_string(clips.size()) + " |\n";
    }
    text += "\n";
  }
  return text;
}

/// Returns true for the name of a file that can hold a licence: a library.toml by others
/// must not publish any other file.
bool is_licence_file(const fs::path& file) {
  const std::string word = lower_case(file.filename().string());
  return word.find("licen") != std::string::npos ||
         word.find("copying") != std::string::npos || word.ends_with(".txt") ||
         word.ends_with(".md");
}

/// Returns the text of a licence that is a file; empty if it is none.
std::string licence_file_text(const std::string& expression, const fs::path& library) {
  constexpr std::uintmax_t kMaxBytes = 256 * 1024;
  const fs::path file = library / expression;
  std::error_code problem;
  if (!is_licence_file(file) || !fs::is_regular_file(file, problem)) return {};
  if (fs::file_size(file, problem) > kMaxBytes || problem) return {};
  const auto text = recordings::read_file(file);
  return text ? *text : std::string();
}

std::string conditions_of(const library::LicenceDecision& decision) {
  if (decision.applied.size() == 1 && decision.applied.front() == "unknown") {
    return "No permission is stated. Ask the origin before any use.";
  }
  std::string text;
  for (const std::string& licence : decision.applied) {
    if (library::terms_of_licence(licence)) continue;
    text += "marey does not know the terms of " + licence + ". Read them. ";
  }
  if (!decision.terms.allows_commercial_use) text += "No commercial use. ";
  if (!decision.terms.allows_changes) text += "No changed copies. ";
  if (decision.terms.needs_attribution) text += "Name the origin. ";
  if (decision.terms.needs_same_licence) text += "Changed copies keep the licence. ";
  if (text.empty()) text = "No conditions. ";
  text.pop_back();
  return text;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += between;
    text += word;
  }
  return text;
}

std::string origin_line(const Provenance& origin) {
  std::string text = "- ";
  text += origin.attribution.empty() ? "no attribution stated" : origin.attribution;
  if (!origin.origin.empty()) text += "; from " + origin.origin;
  if (!origin.commit.empty()) text += ", version " + origin.commit;
  return printable(text) + "\n";
}

}  // namespace

std::size_t count_without_subject(const ExportReport& report) {
  return static_cast<std::size_t>(std::ranges::count_if(
      report.clips, [](const auto& clip) { return clip.provenance.subject.empty(); }));
}

std::string version_of_library(const fs::path& library) {
  const auto head =
      recordings::read_index_head(recordings::LibraryPaths(library).index());
  if (!head || head->version == 0) return "none";
  return std::to_string(head->version) + ", SHA-256 " + head->version_name;
}

std::string licences_text(const ExportReport& report, const ExportOptions& options) {
  std::map<std::string, std::vector<const ClipRecord*>> clips;
  for (const ClipRecord& clip : report.clips) {
    const std::string& licence = clip.provenance.licence;
    clips[licence.empty() ? "unknown" : licence].push_back(&clip);
  }
  std::string text = "# Licences\n\nEach clip keeps the licence of its source.\n\n";
  for (const LicenceGroup& group : report.licences) {
    const auto found = clips.find(group.expression);
    if (found == clips.end()) continue;
    std::string heading = in_cell(group.expression);
    text += "## " + heading + "\n\n";
    if (group.decision.is_choice) {
      text += "The most permissive alternative was chosen: " +
              joined(group.decision.applied, " AND ") + ".\n";
    }
    text += conditions_of(group.decision) + "\n\n";
    std::set<std::string> origins;
    for (const ClipRecord* clip : found->second) {
      origins.insert(origin_line(clip->provenance));
    }
    text += "Origin:\n\n";
    for (const std::string& line : origins) text += line;
    text += "\nClips: " + std::to_string(found->second.size()) + "\n\n```\n";
    for (const ClipRecord* clip : found->second) text += clip->clip_id + "\n";
    text += "```\n\n";
    const std::string own = licence_file_text(group.expression, options.library);
    if (!own.empty()) text += "Text of the licence:\n\n````\n" + own + "\n````\n\n";
  }
  return text;
}

std::string datasheet_text(const ExportReport& report, const ExportOptions& options) {
  ClipCount all;
  for (const ClipRecord& clip : report.clips) all.add(clip);
  std::string text = "# Data sheet\n\n";
  text += std::to_string(all.clips) + " clips, " + std::to_string(report.frames) +
          " frames, " + hours(all.seconds) + " hours.\n\n";
  text += "Version of the library: " + version_of_library(options.library) +
          ". Written by marey " + std::string(kVersion) + ".\n\n## Settings\n\n";
  text += settings_of(options);
  const std::size_t unknown = count_without_subject(report);
  if (unknown > 0 && options.split_by == library::SplitBy::kSubject) {
    text += std::to_string(unknown) +
            " clips have no subject. The splits keep their sources together, but can "
            "divide a person.\n\n";
  }
  text += "## Contents\n\n";
  text +=
      table_of("split", count_by(report, [](const auto& clip) { return clip.split; }));
  text += table_of("licence", count_by(report, [](const auto& clip) {
                     return clip.provenance.licence;
                   }));
  text += table_of("subject", count_by(report, [](const auto& clip) {
                     return clip.provenance.subject;
                   }));
  text += table_of("quality", count_by(report, [](const auto& clip) {
                     return std::string(name(clip.quality));
                   }));
  text += table_of(
      "rate", count_by(report, [](const auto& clip) { return rate_word(clip.rate_hz); }));
  text += table_of("kind", count_by(report, [](const auto& clip) -> std::string {
                     if (!clip.duplicate_of.empty()) return "duplicate of another clip";
                     if (!clip.mirror_of.empty()) return "mirrored copy";
                     return "original";
                   }));
  text += labels_of(report);
  return text + left_out_of(report);
}

}  // namespace marey::app
