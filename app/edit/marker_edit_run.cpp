// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/marker_edit_run.h"

#include <iterator>
#include <string>
#include <utility>

namespace marey::app {

Result<MarkerEditRun> run_marker_edit(EditRecipe recipe,
                                      const MarkerEditRunOptions& options,
                                      const Progress& progress) {
  MarkerEditRun run;
  run.recipe = std::move(recipe);
  auto files = read_marker_edit_files(run.recipe, options.read);
  if (!files) return files.error();
  run.files = *std::move(files);
  edit::RenderMarkersOptions render;
  render.until = options.until;
  render.recipe_file = options.read.recipe_file;
  auto rendered = edit::render_markers(run.recipe, run.files.source, render, progress);
  if (!rendered) return rendered.error();
  run.rendered = *std::move(rendered);
  run.figures = measure_marker_edit(run.recipe, run.files, run.rendered);
  return run;
}

std::vector<Finding> findings_of_marker_edit(const MarkerEditRun& run,
                                             const EditOutput& output) {
  std::vector<Finding> out;
  for (const std::string& remark : run.files.remarks) {
    out.push_back(fair_finding("note", "", remark));
  }
  for (const edit::OpReport& report : run.rendered.reports) {
    for (Finding finding : report.findings) {
      const std::string place =
          "operation " + std::to_string(report.index + 1) + " (" + report.name + ")";
      finding.where = finding.where.empty() ? place : place + ": " + finding.where;
      out.push_back(std::move(finding));
    }
  }
  auto content = assess_marker_content(run.recipe, run.files, run.rendered, output);
  std::move(content.begin(), content.end(), std::back_inserter(out));
  auto poor = assess_edit(run.recipe, run.figures);
  std::move(poor.begin(), poor.end(), std::back_inserter(out));
  return out;
}

}  // namespace marey::app
