// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/library_check.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/quantile.h"

namespace marey::app {
namespace {

constexpr double kSecondsPerHour = 3600.0;

/// Order of clips: the greater, the worse.
struct ClipBadness {
  Verdict quality = Verdict::kPass;
  int failing = 0;
  int warning = 0;
  double excess = 0.0;  ///< Largest value over its limit of warnings.

  auto operator<=>(const ClipBadness&) const = default;
};

ClipBadness badness(const ClipRecord& clip, const library::QualityLimits& limits) {
  ClipBadness out;
  out.quality = clip.quality;
  for (const ClipFigure& figure : clip.figures) {
    const Verdict verdict = figure.verdict.value_or(Verdict::kPass);
    if (verdict == Verdict::kPass) continue;
    ++(verdict == Verdict::kFail ? out.failing : out.warning);
    const auto rule = std::ranges::find(
        limits.rules(), std::string_view(figure.name), &library::FigureRule::figure);
    if (rule != limits.rules().end() && rule->warn > 0.0) {
      out.excess = std::max(out.excess, figure.value / rule->warn);
    }
  }
  return out;
}

/// A figure while its clips are counted.
struct FigureValues {
  FigureSummary summary;
  std::vector<double> values;
};

void add_value(FigureValues& of, const ClipFigure& figure, std::size_t clip) {
  FigureSummary& summary = of.summary;
  if (figure.verdict) ++summary.verdicts[static_cast<std::size_t>(*figure.verdict)];
  if (of.values.empty() || figure.value > summary.max) {
    summary.max = figure.value;
    summary.worst_clip = clip;
  }
  of.values.push_back(figure.value);
}

void finish_summary(FigureValues& of) {
  of.summary.clips = static_cast<int>(of.values.size());
  of.summary.median = median(of.values);
  of.summary.p95 = quantile(std::move(of.values), 0.95);
}

std::vector<FigureSummary> summarize_figures(const std::vector<ClipRecord>& clips,
                                             const library::QualityLimits& limits) {
  std::map<std::string, FigureValues, std::less<>> by_name;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    for (const ClipFigure& figure : clips[i].figures) {
      add_value(by_name[figure.name], figure, i);
    }
  }
  std::vector<FigureSummary> out;
  for (const library::FigureRule& rule : limits.rules()) {
    const auto found = by_name.find(rule.figure);
    if (found == by_name.end()) continue;
    FigureSummary& summary = found->second.summary;
    summary.figure = rule.figure;
    summary.kind = rule.kind;
    summary.is_judged = rule.is_judged;
    summary.warn = rule.warn;
    summary.fail = rule.fail;
    finish_summary(found->second);
    out.push_back(std::move(summary));
    by_name.erase(found);
  }
  for (auto& [name, values] : by_name) {
    values.summary.figure = name;
    finish_summary(values);
    out.push_back(std::move(values.summary));
  }
  return out;
}

std::vector<KindSummary> summarize_kinds(const std::vector<ClipRecord>& clips) {
  std::map<std::string, KindSummary> kinds;
  for (const ClipRecord& clip : clips) {
    std::map<std::string_view, bool> known;
    for (const ClipProblem& problem : clip.problems) {
      KindSummary& kind = kinds[problem.kind];
      kind.kind = problem.kind;
      ++kind.problems;
      const SecondsRange range = seconds_of(clip, problem.frames);
      kind.seconds += range.end_s - range.start_s;
      if (known.emplace(problem.kind, true).second) ++kind.clips;
    }
  }
  std::vector<KindSummary> out;
  for (auto& [name, kind] : kinds) out.push_back(std::move(kind));
  std::ranges::stable_sort(out, std::greater(), &KindSummary::clips);
  return out;
}

std::vector<std::size_t> order_by_badness(const std::vector<ClipRecord>& clips,
                                          const library::QualityLimits& limits) {
  std::vector<ClipBadness> keys;
  keys.reserve(clips.size());
  for (const ClipRecord& clip : clips) keys.push_back(badness(clip, limits));
  std::vector<std::size_t> out(clips.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::ranges::stable_sort(out, [&](std::size_t a, std::size_t b) {
    return std::partial_order(keys[a], keys[b]) > 0;
  });
  return out;
}

}  // namespace

LibraryCheck check_library(std::vector<ClipRecord> clips,
                           const library::QualityLimits& limits,
                           std::vector<FailedSource> failed) {
  LibraryCheck out;
  out.clips = std::move(clips);
  out.failed = std::move(failed);
  for (const ClipRecord& clip : out.clips) {
    const double hours = clip.duration_s() / kSecondsPerHour;
    for (ClipTotal* total :
         {&out.total, &out.by_verdict[static_cast<std::size_t>(clip.quality)]}) {
      ++total->clips;
      total->hours += hours;
    }
    if (!clip.duplicate_of.empty()) ++out.duplicates;
  }
  out.figures = summarize_figures(out.clips, limits);
  out.kinds = summarize_kinds(out.clips);
  out.worst_first = order_by_badness(out.clips, limits);
  return out;
}

const ClipFigure* find_figure(const ClipRecord& clip, std::string_view figure) {
  const auto found = std::ranges::find(clip.figures, figure, &ClipFigure::name);
  return found == clip.figures.end() ? nullptr : &*found;
}

Verdict verdict_of_kind(const ClipRecord& clip, std::string_view kind) {
  Verdict worst = Verdict::kWarn;
  for (const library::FigureRule& rule : library::figure_rules()) {
    if (rule.kind != kind) continue;
    const ClipFigure* figure = find_figure(clip, rule.figure);
    if (figure != nullptr) {
      worst = std::max(worst, figure->verdict.value_or(Verdict::kPass));
    }
  }
  return worst;
}

std::string unit_of_kind(std::string_view kind) {
  // A longer ending is before its own end.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kEndings = {{
      {"_cm_s", " cm/s"},
      {"_mm", " mm"},
      {"_deg", " deg"},
      {"_s", " s"},
  }};
  std::optional<std::string_view> unit;
  for (const library::FigureRule& rule : library::figure_rules()) {
    if (rule.kind != kind) continue;
    const auto ending = std::ranges::find_if(
        kEndings, [&](const auto& one) { return rule.figure.ends_with(one.first); });
    const std::string_view own = ending == kEndings.end() ? "" : ending->second;
    if (unit && *unit != own) return {};
    unit = own;
  }
  return std::string(unit.value_or(""));
}

SecondsRange seconds_of(const ClipRecord& clip, const FrameRange& frames) {
  if (clip.rate_hz <= 0.0) return {};
  return {frames.first / clip.rate_hz, (frames.last + 1) / clip.rate_hz};
}

}  // namespace marey::app
