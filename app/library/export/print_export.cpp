// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/library/export/export_commands.h"
#include "app/library/export/export_report.h"
#include "app/library/export/export_sheets.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

double total_hours(const ExportReport& report) {
  double seconds = 0.0;
  for (const ClipRecord& clip : report.clips) seconds += clip.duration_s();
  return seconds / 3600.0;
}

std::map<std::string, int> clips_by_split(const ExportReport& report) {
  std::map<std::string, int> out;
  for (const ClipRecord& clip : report.clips) ++out[clip.split];
  return out;
}

Json export_json(const ExportReport& report, const ExportOptions& options) {
  Json licences = Json::array();
  for (const LicenceGroup& group : report.licences) {
    licences.push_back({{"licence", group.expression},
                        {"applied", group.decision.applied},
                        {"clips", group.clips.size()}});
  }
  Json left_out = Json::array();
  for (const LeftOutClip& clip : report.left_out) {
    left_out.push_back(
        {{"clip_id", clip.clip_id}, {"name", clip.name}, {"reason", clip.reason}});
  }
  Json sides = Json::array();
  for (const UnknownSide& side : report.unknown_sides) {
    sides.push_back({{"clip_id", side.clip_id}, {"label", side.label}});
  }
  return {{"format", 1},
          {"folder", options.out.string()},
          {"as", name(options.format)},
          {"skeleton", options.skeleton},
          {"version", version_of_library(options.library)},
          {"clips", report.clips.size()},
          {"frames", report.frames},
          {"hours", total_hours(report)},
          {"splits", clips_by_split(report)},
          {"licences", std::move(licences)},
          {"not_selected", report.in_library - report.selected},
          {"left_out", std::move(left_out)},
          {"labels_without_other_side", std::move(sides)}};
}

void say_export(const ExportReport& report,
                const ExportOptions& options,
                Console& console) {
  std::string splits;
  for (const auto& [split, clips] : clips_by_split(report)) {
    splits += format_text(", %s %d", split.c_str(), clips);
  }
  console.say(format_text("%s: %zu clips, %.3f hours%s",
                          options.out.string().c_str(),
                          report.clips.size(),
                          total_hours(report),
                          splits.c_str()));
  for (const LicenceGroup& group : report.licences) {
    if (!group.decision.is_choice) continue;
    std::string applied;
    for (const std::string& licence : group.decision.applied) {
      applied += (applied.empty() ? "" : " AND ") + licence;
    }
    console.say(group.expression + ": exported under " + applied);
  }
}

void warn_of_attribution(const ExportReport& report, Console& console) {
  std::set<std::string> nameless;
  for (const LicenceGroup& group : report.licences) {
    if (!group.decision.terms.needs_attribution) continue;
    const bool is_nameless = std::ranges::any_of(report.clips, [&](const auto& clip) {
      return clip.provenance.licence == group.expression &&
             clip.provenance.attribution.empty();
    });
    if (is_nameless) nameless.insert(group.expression);
  }
  for (const std::string& licence : nameless) {
    console.warn("sources under " + licence +
                 " state no attribution, which their licence may demand. Next: set "
                 "attribution for them in library.toml.");
  }
}

void warn_of_subjects(const ExportReport& report,
                      const ExportOptions& options,
                      Console& console) {
  const std::size_t unknown = count_without_subject(report);
  const bool divides = options.splits.size() > 1;
  if (unknown == 0 || !divides || options.split_by == library::SplitBy::kClip) return;
  console.warn(
      std::to_string(unknown) + " of " + std::to_string(report.clips.size()) +
      " clips have no subject; the splits can divide a person. Next: set subject "
      "for their sources in library.toml.");
}

}  // namespace

Exit print_export(const ExportReport& report,
                  const ExportOptions& options,
                  bool as_json,
                  Console& console) {
  warn_of_attribution(report, console);
  warn_of_subjects(report, options, console);
  std::set<std::string> labels;
  for (const UnknownSide& side : report.unknown_sides) {
    if (!labels.insert(side.label).second) continue;
    console.warn("label " + in_quotes(side.label) +
                 ": its other side is not known; mirrored copies do not have this label. "
                 "Next: write "
                 "left or right as a word of its own.");
  }
  if (as_json) {
    std::printf("%s\n", export_json(report, options).dump(2).c_str());
  } else {
    say_export(report, options, console);
  }
  if (report.left_out.empty()) return Exit::kOk;
  const LeftOutClip& first = report.left_out.front();
  return console.fail({Errc::kQuality,
                       options.out.string(),
                       std::to_string(report.left_out.size()) + " of " +
                           std::to_string(report.selected) +
                           " selected clips cannot be exported; the first, " +
                           first.name + ": " + first.reason,
                       "read DATASHEET.md, which lists them all"});
}

}  // namespace marey::app
