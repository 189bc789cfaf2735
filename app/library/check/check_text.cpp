// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/check_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/shell/word_list.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/base/printable.h"

namespace marey::app {
namespace {

constexpr std::size_t kMaxProblemsOfClip = 4;

std::string hours_of(double hours) {
  return hours >= 0.1 ? format_text("%.2f h", hours)
                      : format_text("%.1f min", 60.0 * hours);
}

std::string name_of(const ClipRecord& clip) {
  return printable(clip.name.empty() ? clip.clip_id : clip.name);
}

void add_totals(const LibraryCheck& check, std::vector<std::string>& out) {
  out.push_back(format_text("%s: %d clips, %s",
                            printable(check.library).c_str(),
                            check.total.clips,
                            hours_of(check.total.hours).c_str()));
  if (!check.query.empty()) out.back() += " of the query " + in_quotes(check.query);
  if (check.duplicates > 0) {
    out.back() += format_text(", %d of them duplicates", check.duplicates);
  }
  for (std::size_t i = 0; i < kVerdictCount; ++i) {
    const ClipTotal& total = check.by_verdict[i];
    const double share =
        check.total.clips > 0 ? 100.0 * total.clips / check.total.clips : 0;
    out.push_back(format_text("  %-5s %6d clips %6.1f %%  %s",
                              std::string(name(static_cast<Verdict>(i))).c_str(),
                              total.clips,
                              share,
                              hours_of(total.hours).c_str()));
  }
}

std::string place_text(const ClipRecord& clip,
                       const std::string& joint,
                       const std::optional<FrameRange>& frames) {
  std::string out = joint.empty() ? "" : ", " + printable(joint);
  if (frames) {
    out += format_text(", frames %d-%d", frames->first, frames->last);
    const SecondsRange range = seconds_of(clip, *frames);
    if (range.end_s > 0.0) out += format_text(" (%.2f s)", range.start_s);
  }
  return out;
}

void add_figures(const LibraryCheck& check, std::vector<std::string>& out) {
  const auto has_trouble = [](const FigureSummary& figure) {
    return figure.verdicts[1] + figure.verdicts[2] > 0;
  };
  if (!std::ranges::any_of(check.figures, has_trouble)) return;
  out.emplace_back();
  out.push_back("figure            warn   fail   worst");
  for (const FigureSummary& figure : check.figures) {
    if (!has_trouble(figure)) continue;
    const ClipRecord& clip = check.clips[figure.worst_clip];
    const ClipFigure* worst = find_figure(clip, figure.figure);
    out.push_back(format_text("%-15s %6d %6d   %s (limits %s, %s) in %s",
                              printable(figure.figure).c_str(),
                              figure.verdicts[1],
                              figure.verdicts[2],
                              short_number(figure.max).c_str(),
                              short_number(figure.warn).c_str(),
                              short_number(figure.fail).c_str(),
                              name_of(clip).c_str()) +
                  place_text(clip, worst->joint, worst->frames));
  }
}

void add_kinds(const LibraryCheck& check, std::vector<std::string>& out) {
  if (check.kinds.empty()) return;
  out.emplace_back();
  out.push_back("problem          clips places      time");
  for (const KindSummary& kind : check.kinds) {
    out.push_back(format_text("%-15s %6d %6d %7.1f s",
                              printable(kind.kind).c_str(),
                              kind.clips,
                              kind.problems,
                              kind.seconds));
  }
}

std::string problem_text(const ClipRecord& clip, const ClipProblem& problem) {
  const SecondsRange range = seconds_of(clip, problem.frames);
  std::string out = "    " + printable(problem.kind);
  if (!problem.joint.empty()) out += " of " + printable(problem.joint);
  return out +
         format_text(" at %.2f-%.2f s: %s",
                     range.start_s,
                     range.end_s,
                     short_number(problem.value).c_str()) +
         unit_of_kind(problem.kind);
}

void add_worst_clips(const LibraryCheck& check,
                     std::size_t max_clips,
                     std::vector<std::string>& out) {
  std::size_t bad = 0;
  for (const ClipRecord& clip : check.clips)
    bad += clip.quality != Verdict::kPass ? 1 : 0;
  if (bad == 0) return;
  out.emplace_back();
  out.push_back("worst clips:");
  for (std::size_t i = 0; i < std::min(bad, max_clips); ++i) {
    const ClipRecord& clip = check.clips[check.worst_first[i]];
    out.push_back(format_text("  %s %s %s, %.2f s",
                              std::string(name(clip.quality)).c_str(),
                              clip.clip_id.c_str(),
                              name_of(clip).c_str(),
                              clip.duration_s()));
    for (std::size_t k = 0; k < std::min(clip.problems.size(), kMaxProblemsOfClip); ++k) {
      out.push_back(problem_text(clip, clip.problems[k]));
    }
    if (clip.problems.size() > kMaxProblemsOfClip) {
      out.push_back(
          format_text("    and %zu more", clip.problems.size() - kMaxProblemsOfClip));
    }
  }
  if (bad > max_clips) {
    out.push_back(
        format_text("  and %zu more: see the page, or use --json", bad - max_clips));
  }
}

void add_failed_sources(const LibraryCheck& check,
                        std::size_t max_sources,
                        std::vector<std::string>& out) {
  if (check.failed.empty()) return;
  out.emplace_back();
  out.push_back(counted(check.failed.size(), "source") + " gave no clip:");
  for (std::size_t i = 0; i < std::min(check.failed.size(), max_sources); ++i) {
    const FailedSource& source = check.failed[i];
    out.push_back("  " + (source.where.empty() ? source.source : source.where) + ": " +
                  source.cause + ".");
    if (!source.next.empty()) out.back() += " Next: " + source.next + ".";
  }
  if (check.failed.size() > max_sources) {
    out.push_back(format_text("  and %zu more in %s/failed/",
                              check.failed.size() - max_sources,
                              check.folder.c_str()));
  }
}

}  // namespace

std::string short_number(double value) {
  const double size = std::abs(value);
  if (size >= 1e5) return format_text("%.3g", value);
  const int decimals = size >= 100.0 ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3;
  std::string out = format_text("%.*f", decimals, value);
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.ends_with('.')) out.pop_back();
  }
  return out == "-0" ? "0" : out;
}

std::vector<std::string> check_lines(const LibraryCheck& check, std::size_t max_clips) {
  std::vector<std::string> out;
  add_totals(check, out);
  add_figures(check, out);
  add_kinds(check, out);
  add_worst_clips(check, max_clips, out);
  add_failed_sources(check, max_clips, out);
  return out;
}

}  // namespace marey::app
