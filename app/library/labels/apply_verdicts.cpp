// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/apply_verdicts.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "library/quality/quality_limits.h"

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

using recordings::VerdictCorrection;

/// Returns the kind of a figure's problems; empty: it is no figure of the gate.
std::string_view kind_of_figure(std::string_view figure) {
  const auto rules = library::figure_rules();
  const auto rule = std::ranges::find(rules, figure, &library::FigureRule::figure);
  return rule == rules.end() ? std::string_view() : rule->kind;
}

bool overlaps(const FrameRange& a, const FrameRange& b) {
  return a.first <= b.last && b.first <= a.last;
}

/// Removes the problems of a kind that no figure confirms any more.
void remove_dismissed(ClipRecord& record, std::string_view kind) {
  const bool is_confirmed =
      std::ranges::any_of(record.figures, [&](const ClipFigure& figure) {
        return figure.verdict.value_or(Verdict::kPass) != Verdict::kPass &&
               kind_of_figure(figure.name) == kind;
      });
  if (is_confirmed) return;
  std::erase_if(record.problems,
                [&](const ClipProblem& problem) { return problem.kind == kind; });
}

void add_reported(ClipRecord& record,
                  const ClipFigure& figure,
                  const FrameRange& frames,
                  std::string_view kind) {
  const int last = record.frame_count() - 1;
  if (frames.first > last) return;
  record.problems.push_back({{frames.first, std::min(frames.last, last)},
                             std::string(kind),
                             figure.joint,
                             figure.value});
  std::ranges::stable_sort(record.problems, {}, [](const ClipProblem& problem) {
    return std::tie(problem.frames.first, problem.kind, problem.joint);
  });
}

/// Returns false if the correction has no effect.
bool correct_figure(ClipRecord& record, const VerdictCorrection& correction) {
  const auto figure =
      std::ranges::find(record.figures, correction.figure, &ClipFigure::name);
  if (figure == record.figures.end()) return false;
  const Verdict measured = figure->verdict.value_or(Verdict::kPass);
  const std::string_view kind = kind_of_figure(figure->name);
  if (correction.verdict > measured) {
    figure->verdict = correction.verdict;
    if (correction.frames && !kind.empty()) {
      add_reported(record, *figure, *correction.frames, kind);
    }
    return true;
  }
  const bool is_elsewhere = correction.frames && figure->frames &&
                            !overlaps(*correction.frames, *figure->frames);
  if (is_elsewhere) return false;
  figure->verdict = correction.verdict;
  if (correction.verdict == Verdict::kPass) remove_dismissed(record, kind);
  return true;
}

Verdict worst_figure(const ClipRecord& record) {
  Verdict worst = Verdict::kPass;
  for (const ClipFigure& figure : record.figures) {
    worst = std::max(worst, figure.verdict.value_or(Verdict::kPass));
  }
  return worst;
}

}  // namespace

std::vector<VerdictCorrection> apply_verdicts(
    ClipRecord& record, std::span<const VerdictCorrection> corrections) {
  std::vector<VerdictCorrection> unused;
  std::optional<Verdict> quality;
  bool has_changed = false;
  for (const VerdictCorrection& correction : corrections) {
    if (correction.clip != record.clip_id) {
      unused.push_back(correction);
    } else if (correction.figure == recordings::kQualityFigure) {
      quality = correction.verdict;
    } else if (correct_figure(record, correction)) {
      has_changed = true;
    } else {
      unused.push_back(correction);
    }
  }
  if (has_changed) record.quality = worst_figure(record);
  if (quality) record.quality = *quality;
  return unused;
}

std::vector<UnusedLabel> apply_library_verdicts(const LibraryLabels& labels,
                                                std::vector<ClipRecord>& records) {
  std::unordered_map<std::string_view, std::vector<VerdictCorrection>> by_clip;
  for (const VerdictCorrection& correction : labels.verdicts) {
    by_clip[correction.clip].push_back(correction);
  }
  const std::string file = "labels/" + std::string(recordings::kVerdictFile);
  std::vector<UnusedLabel> unused;
  for (ClipRecord& record : records) {
    const auto found = by_clip.find(record.clip_id);
    if (found == by_clip.end()) continue;
    for (const VerdictCorrection& correction : apply_verdicts(record, found->second)) {
      unused.push_back({file,
                        correction.line,
                        "the clip " + in_quotes(correction.clip) + " has no figure " +
                            in_quotes(correction.figure) +
                            ", or it is about other frames"});
    }
    by_clip.erase(found);
  }
  for (const auto& [clip, corrections] : by_clip) {
    for (const VerdictCorrection& correction : corrections) {
      unused.push_back(
          {file, correction.line, "no clip has the id " + in_quotes(correction.clip)});
    }
  }
  std::ranges::sort(unused, {}, &UnusedLabel::line);
  return unused;
}

}  // namespace marey::app
