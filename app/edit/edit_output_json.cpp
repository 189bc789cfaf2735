// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_output_json.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/shell/findings.h"
#include "app/view/constraint_kind.h"
#include "core/source.h"
#include "live/page/page_scene.h"

namespace marey::app {
namespace {

using OutputJson = nlohmann::ordered_json;

/// Numbers for a graph have five digits after the point: 10 micrometres.
OutputJson graph_number(double value) {
  return std::round(value * 1e5) / 1e5;
}

OutputJson number_or_null(const std::optional<double>& value) {
  return value ? OutputJson(*value) : OutputJson();
}

OutputJson graph_values(const std::vector<std::optional<double>>& values) {
  OutputJson out = OutputJson::array();
  for (const auto& value : values) out.push_back(value ? graph_number(*value) : nullptr);
  return out;
}

OutputJson graph_json(const EditGraph& graph) {
  return {{"name", graph.name},
          {"unit", graph.unit},
          {"values", graph_values(graph.values)},
          {"before", graph_values(graph.before)}};
}

OutputJson runs_json(const std::vector<FrameRange>& runs) {
  OutputJson out = OutputJson::array();
  for (const FrameRange& run : runs) {
    out.push_back(OutputJson::array({run.first, run.last}));
  }
  return out;
}

OutputJson contacts_json(const edit::EditState& state) {
  constexpr std::array<const char*, 2> kSides{"left", "right"};
  OutputJson out = OutputJson::array();
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const FootContacts& foot = state.contacts.feet[side];
    const auto add = [&](const char* part, const std::vector<FrameRange>& spans) {
      out.push_back({{"name", std::string(kSides[side]) + " " + part},
                     {"foot", kSides[side]},
                     {"part", part},
                     {"spans", runs_json(spans)}});
    };
    add("heel", foot.heel);
    add("ball", foot.ball);
  }
  return out;
}

/// Returns the runs of frames for which `same(t - 1, t)` holds.
template <class Same>
std::vector<FrameRange> equal_runs(int frames, const Same& same) {
  std::vector<FrameRange> out;
  for (int t = 0; t < frames; ++t) {
    if (t == 0 || !same(static_cast<std::size_t>(t - 1), static_cast<std::size_t>(t))) {
      out.push_back({t, t});
    }
    out.back().last = t;
  }
  return out;
}

OutputJson trust_json(const edit::EditState& state) {
  const auto& frames = state.lineage.frames;
  OutputJson out = OutputJson::array();
  const auto same = [&](std::size_t a, std::size_t b) {
    return frames[a].trust == frames[b].trust;
  };
  for (const FrameRange& run : equal_runs(state.frame_count(), same)) {
    const Source trust = frames[static_cast<std::size_t>(run.first)].trust;
    if (trust == Source::kMeasured) continue;
    out.push_back(OutputJson::array({run.first, run.last, std::string(name(trust))}));
  }
  return out;
}

/// Returns the gaps of each joint that was measured at all.
OutputJson tracks_json(const edit::EditState& state) {
  OutputJson out = OutputJson::array();
  if (state.uncertainty.empty()) return out;
  const auto& joints = state.motion.skeleton.joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto source = [&](std::size_t t) { return state.uncertainty[t][j].source; };
    OutputJson gaps = OutputJson::array();
    bool is_seen = false;
    for (const FrameRange& run : equal_runs(
             state.frame_count(),
             [&](std::size_t a, std::size_t b) { return source(a) == source(b); })) {
      const Source of_run = source(static_cast<std::size_t>(run.first));
      is_seen |= of_run != Source::kInferred;
      if (of_run == Source::kMeasured) continue;
      gaps.push_back(OutputJson::array({run.first, run.last, std::string(name(of_run))}));
    }
    if (is_seen && !gaps.empty()) {
      out.push_back({{"name", joints[j].name}, {"gaps", std::move(gaps)}});
    }
  }
  return out;
}

/// Returns runs in which the frame of the source advances evenly.
OutputJson sources_json(const edit::EditState& state) {
  constexpr double kEven_frames = 1e-6;
  const auto& frames = state.lineage.frames;
  const auto step = [&](std::size_t t) {
    return frames[t].source_frame - frames[t - 1].source_frame;
  };
  std::size_t run_start = 0;
  const auto same = [&](std::size_t a, std::size_t b) {
    const bool continues =
        frames[a].source == frames[b].source &&
        (a == run_start || std::abs(step(b) - step(run_start + 1)) < kEven_frames);
    if (!continues) run_start = b;
    return continues;
  };
  OutputJson out = OutputJson::array();
  for (const FrameRange& run : equal_runs(state.frame_count(), same)) {
    const auto& first = frames[static_cast<std::size_t>(run.first)];
    const auto& last = frames[static_cast<std::size_t>(run.last)];
    out.push_back(OutputJson::array(
        {run.first, run.last, first.source, first.source_frame, last.source_frame}));
  }
  return out;
}

OutputJson touched_json(const edit::EditState& state) {
  const auto& frames = state.lineage.frames;
  OutputJson out = OutputJson::array();
  const auto same = [&](std::size_t a, std::size_t b) {
    return frames[a].history == frames[b].history;
  };
  for (const FrameRange& run : equal_runs(state.frame_count(), same)) {
    const std::vector<int> ops = edit::ops_of(state.lineage, run.first);
    if (ops.empty()) continue;
    out.push_back(OutputJson::array({run.first, run.last, OutputJson(ops)}));
  }
  return out;
}

OutputJson annotations_json(const Annotations& annotations) {
  OutputJson out = OutputJson::array();
  for (const Annotation& note : annotations.notes) {
    out.push_back(
        {{"text", note.text}, {"start_s", note.start_s}, {"end_s", note.end_s}});
  }
  return out;
}

OutputJson value_curves_json(const Annotations& annotations, const FrameRange& span) {
  OutputJson out = OutputJson::array();
  for (const ValueCurve& curve : annotations.curves) {
    OutputJson values = OutputJson::array();
    for (int t = span.first; t <= span.last; ++t) {
      values.push_back(graph_number(curve.values[static_cast<std::size_t>(t)]));
    }
    out.push_back({{"name", curve.name}, {"values", std::move(values)}});
  }
  return out;
}

OutputJson constraints_json_of(const ConstraintSet& set) {
  OutputJson out = OutputJson::array();
  for (const Constraint& constraint : set.constraints) {
    const auto target = target_in_world(constraint.goal);
    const Activation& active = constraint.activation;
    out.push_back(
        {{"id", constraint.id},
         {"kind", live::name(page_kind(constraint))},
         {"segment", constraint.point.segment},
         {"start_s", number_or_null(active.start_s)},
         {"stop_s", number_or_null(active.stop_s)},
         {"start_duration_s", active.start_duration_s},
         {"stop_duration_s", active.stop_duration_s},
         {"p_in_world",
          target ? OutputJson::array({target->x, target->y, target->z}) : OutputJson()},
         {"draggable", is_draggable_place(constraint)}});
  }
  return out;
}

OutputJson figures_json(const std::optional<EditFigures>& figures) {
  if (!figures) return {};
  return {{"duration_s", figures->duration_s},
          {"slide_mm", figures->slide_mm},
          {"slide_cm_per_s", figures->slide_cm_per_s},
          {"displaced_mm", figures->displaced_mm},
          {"acceleration_ratio", figures->acceleration_ratio},
          {"constraint_mm", figures->constraint_mm},
          {"inferred_frames", figures->inferred_frames}};
}

}  // namespace

OutputJson page_finding_json(const Finding& finding) {
  std::string text = finding.where;
  if (!text.empty() && !finding.cause.empty()) text += ": ";
  text += finding.cause;
  return {{"severity", name(finding.severity)},
          {"id", finding.id},
          {"text", text},
          {"next", finding.next},
          {"value", number_or_null(finding.value)},
          {"limit", number_or_null(finding.limit)},
          {"unit", finding.unit}};
}

OutputJson page_findings_json(const std::vector<Finding>& findings) {
  OutputJson out = OutputJson::array();
  for (const Finding& finding : findings) out.push_back(page_finding_json(finding));
  return out;
}

OutputJson op_report_json(const edit::OpReport& report) {
  OutputJson figures = OutputJson::object();
  for (const auto& [figure, value] : report.figures) figures[figure] = value;
  return {{"op", report.index},
          {"do", report.name},
          {"figures", std::move(figures)},
          {"findings", page_findings_json(report.findings)}};
}

OutputJson output_json(const SentOutput& output) {
  const edit::EditState& state = output.state;
  OutputJson graphs = OutputJson::array();
  for (const EditGraph& graph : output.graphs) graphs.push_back(graph_json(graph));
  return {{"name", output.name},
          {"frames", state.frame_count()},
          {"rate_hz", state.motion.rate.hz},
          {"span", OutputJson::array({output.span.first, output.span.last})},
          {"block", output.block},
          {"contacts", contacts_json(state)},
          {"trust", trust_json(state)},
          {"tracks", tracks_json(state)},
          {"lineage", sources_json(state)},
          {"touched", touched_json(state)},
          {"annotations", annotations_json(state.annotations)},
          {"value_curves", value_curves_json(state.annotations, output.span)},
          {"constraints", constraints_json_of(state.constraints)},
          {"graphs", std::move(graphs)},
          {"figures", figures_json(output.figures)}};
}

}  // namespace marey::app
