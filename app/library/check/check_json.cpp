// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/check_json.h"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"
#include "app/shell/version.h"

namespace marey::app {
namespace {

using CheckJson = nlohmann::ordered_json;

CheckJson total_json(const ClipTotal& total) {
  return {{"clips", total.clips}, {"hours", rounded(total.hours, 4)}};
}

CheckJson frames_json(const std::optional<FrameRange>& frames) {
  return frames ? CheckJson::array({frames->first, frames->last}) : CheckJson();
}

CheckJson limits_json(const FigureSummary& figure) {
  return figure.is_judged ? CheckJson::array({figure.warn, figure.fail}) : CheckJson();
}

CheckJson figure_summary_json(const LibraryCheck& check, const FigureSummary& figure) {
  const ClipRecord& clip = check.clips[figure.worst_clip];
  const ClipFigure* worst = find_figure(clip, figure.figure);
  return {{"figure", figure.figure},
          {"kind", figure.kind},
          {"limits", limits_json(figure)},
          {"clips", figure.clips},
          {"warned", figure.verdicts[1]},
          {"failed", figure.verdicts[2]},
          {"median", figure.median},
          {"p95", figure.p95},
          {"worst",
           {{"clip", clip.clip_id},
            {"name", clip.name},
            {"value", figure.max},
            {"joint", worst->joint},
            {"frames", frames_json(worst->frames)}}}};
}

CheckJson kind_json(const KindSummary& kind) {
  return {{"kind", kind.kind},
          {"clips", kind.clips},
          {"problems", kind.problems},
          {"seconds", rounded(kind.seconds, 3)}};
}

CheckJson failed_json(const FailedSource& source) {
  return {{"source", source.source},
          {"where", source.where},
          {"cause", source.cause},
          {"next", source.next}};
}

CheckJson clip_figure_json(const ClipFigure& figure) {
  return {{"name", figure.name},
          {"value", figure.value},
          {"verdict",
           figure.verdict ? CheckJson(std::string(name(*figure.verdict))) : CheckJson()},
          {"joint", figure.joint},
          {"frames", frames_json(figure.frames)}};
}

CheckJson clip_problem_json(const ClipRecord& clip, const ClipProblem& problem) {
  const SecondsRange range = seconds_of(clip, problem.frames);
  return {{"kind", problem.kind},
          {"joint", problem.joint},
          {"value", problem.value},
          {"frames", frames_json(problem.frames)},
          {"start_s", rounded(range.start_s, 4)},
          {"end_s", rounded(range.end_s, 4)}};
}

CheckJson checked_clip_json(const ClipRecord& clip) {
  CheckJson out = {{"clip", clip.clip_id},
                   {"name", clip.name},
                   {"source", clip.provenance.path},
                   {"licence", clip.provenance.licence},
                   {"quality", name(clip.quality)},
                   {"seconds", rounded(clip.duration_s(), 4)},
                   {"rate_hz", clip.rate_hz},
                   {"duplicate_of", clip.duplicate_of},
                   {"figures", CheckJson::array()},
                   {"problems", CheckJson::array()}};
  // Lists are filled in place: an initializer would copy them.
  CheckJson& figures = out["figures"];
  for (const ClipFigure& figure : clip.figures) {
    figures.push_back(clip_figure_json(figure));
  }
  CheckJson& problems = out["problems"];
  for (const ClipProblem& problem : clip.problems) {
    problems.push_back(clip_problem_json(clip, problem));
  }
  return out;
}

}  // namespace

nlohmann::ordered_json check_summary_json(const LibraryCheck& check) {
  CheckJson verdicts = CheckJson::object();
  for (std::size_t i = 0; i < kVerdictCount; ++i) {
    verdicts[std::string(name(static_cast<Verdict>(i)))] =
        total_json(check.by_verdict[i]);
  }
  CheckJson out = {{"format", 1},
                   {"marey_version", kVersion},
                   {"library", check.library},
                   {"query", check.query},
                   {"total", total_json(check.total)},
                   {"verdicts", verdicts},
                   {"duplicates", check.duplicates},
                   {"figures", CheckJson::array()},
                   {"kinds", CheckJson::array()},
                   {"failed", CheckJson::array()}};
  for (const FigureSummary& figure : check.figures) {
    out["figures"].push_back(figure_summary_json(check, figure));
  }
  for (const KindSummary& kind : check.kinds) out["kinds"].push_back(kind_json(kind));
  for (const FailedSource& source : check.failed) {
    out["failed"].push_back(failed_json(source));
  }
  return out;
}

nlohmann::ordered_json check_json(const LibraryCheck& check) {
  CheckJson out = check_summary_json(check);
  CheckJson& clips = out["clips"] = CheckJson::array();
  for (const std::size_t i : check.worst_first)
    clips.push_back(checked_clip_json(check.clips[i]));
  return out;
}

}  // namespace marey::app
