// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_json.h"

#include <cmath>
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "app/shell/findings.h"
#include "core/source.h"

namespace marey::app {
namespace {

using nlohmann::ordered_json;

/// Numbers are rounded so that a file can be read.
double rounded(double value) {
  return std::round(value * 1e6) / 1e6;
}

bool continues(const edit::FrameLineage& before, const edit::FrameLineage& next) {
  return next.source == before.source && next.trust == before.trust &&
         next.history == before.history;
}

}  // namespace

ordered_json edit_lineage_json(const edit::Lineage& lineage) {
  const auto& frames = lineage.frames;
  ordered_json out = ordered_json::array();
  std::size_t first = 0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    if (t + 1 < frames.size() && continues(frames[t], frames[t + 1])) continue;
    out.push_back(
        {{"frames", {first, t}},
         {"source", frames[first].source},
         {"source_frames",
          {rounded(frames[first].source_frame), rounded(frames[t].source_frame)}},
         {"operations", edit::ops_of(lineage, static_cast<int>(first))},
         {"invented", frames[first].trust == Source::kInferred}});
    first = t + 1;
  }
  return out;
}

ordered_json edit_report_json(const edit::OpReport& report) {
  ordered_json figures = ordered_json::object();
  for (const auto& [name, value] : report.figures) figures[name] = rounded(value);
  return {{"operation", report.index},
          {"do", report.name},
          {"figures", figures},
          {"findings", findings_json(report.findings)}};
}

ordered_json edit_figures_json(const EditFigures& figures) {
  return {{"name", figures.name},
          {"frames", figures.frames},
          {"duration_s", rounded(figures.duration_s)},
          {"slide_mm", rounded(figures.slide_mm)},
          {"slide_cm_per_s", rounded(figures.slide_cm_per_s)},
          {"displaced_mm", rounded(figures.displaced_mm)},
          {"acceleration_ratio", rounded(figures.acceleration_ratio)},
          {"constraint_mm", rounded(figures.constraint_mm)},
          {"inferred_frames", figures.inferred_frames}};
}

ordered_json edit_json(const EditRecipe& recipe,
                       const EditFiles& files,
                       const edit::Rendered& rendered,
                       const std::vector<EditFigures>& figures) {
  ordered_json sources = ordered_json::array();
  for (std::size_t i = 0; i < recipe.sources.size(); ++i) {
    const EditSource& source = recipe.sources[i];
    sources.push_back({{"id", source.id},
                       {"path", source.path},
                       {"sha256", files.sha256[i].substr(0, 64)}});
  }
  ordered_json operations = ordered_json::array();
  for (const edit::OpReport& report : rendered.reports) {
    operations.push_back(edit_report_json(report));
  }
  ordered_json results = ordered_json::array();
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    ordered_json result = edit_figures_json(figures[i]);
    result["lineage"] = edit_lineage_json(rendered.outputs[i].lineage);
    results.push_back(std::move(result));
  }
  return {{"format", 1},
          {"name", recipe.name},
          {"sources", sources},
          {"operations", operations},
          {"results", results}};
}

}  // namespace marey::app
