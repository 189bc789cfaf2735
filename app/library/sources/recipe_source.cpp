// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/recipe_source.h"

#include <cmath>
#include <string>
#include <utility>

#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "app/shell/console.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

void adopt_annotations(const Annotations& annotations,
                       double rate_hz,
                       SourceMotion& out) {
  for (const Annotation& note : annotations.notes) {
    if (note.is_event()) {
      const auto frame = static_cast<int>(std::lround(note.start_s * rate_hz));
      out.events.push_back({frame, note.text});
    } else {
      out.labels.push_back({note.start_s, note.end_s, note.text, "recipe", 1.0});
    }
  }
}

/// Adds the remarks of the readers and the findings of the operations.
void add_remarks(const std::vector<std::string>& read,
                 const std::vector<edit::OpReport>& reports,
                 SourceMotion& out) {
  out.remarks.insert(out.remarks.end(), read.begin(), read.end());
  for (const edit::OpReport& report : reports) {
    for (const Finding& finding : report.findings) {
      out.remarks.push_back(report.name + ": " + finding.message());
    }
  }
}

Result<std::vector<SourceMotion>> read_marker_recipe(const fs::path& file,
                                                     EditRecipe recipe,
                                                     const MarkerSourceOptions& options) {
  Console console(ProgressStyle::kKept);
  auto run = render_marker_recipe(file, std::move(recipe), {}, console);
  if (!run) return run.error();
  const std::size_t outputs = run->rendered.outputs.size();
  const std::vector<std::string> names = edit_names(run->recipe, outputs);
  std::vector<SourceMotion> all;
  for (std::size_t i = 0; i < outputs; ++i) {
    edit::MarkerState& state = run->rendered.outputs[i];
    recordings::MarkerFile markers;
    markers.axes = run->files.axes;
    const double rate_hz = state.tracks.rate.hz;
    markers.tracks = std::move(state.tracks);
    auto solved = solve_marker_source(file, std::move(markers), options);
    if (!solved) return solved.error();
    for (SourceMotion& motion : *solved) {
      if (outputs > 1) {
        motion.body = motion.body.empty() ? names[i] : names[i] + ":" + motion.body;
      }
      adopt_annotations(state.annotations, rate_hz, motion);
      add_remarks(run->files.remarks, run->rendered.reports, motion);
      all.push_back(std::move(motion));
    }
  }
  return all;
}

}  // namespace

Result<std::vector<SourceMotion>> read_recipe_source(const fs::path& file,
                                                     const MarkerSourceOptions& options) {
  auto recipe = read_named_recipe(file);
  if (!recipe) return recipe.error();
  if (edits_markers(*recipe, options_of_reading(file, {}))) {
    return read_marker_recipe(file, *std::move(recipe), options);
  }
  Console console(ProgressStyle::kKept);
  auto run = render_recipe(file, *std::move(recipe), {}, console);
  if (!run) return run.error();
  const std::size_t outputs = run->rendered.outputs.size();
  const std::vector<std::string> names = edit_names(run->recipe, outputs);
  std::vector<SourceMotion> all;
  for (std::size_t i = 0; i < outputs; ++i) {
    edit::EditState& state = run->rendered.outputs[i];
    SourceMotion out;
    out.rates.file_hz = state.motion.rate.hz;
    if (outputs > 1) out.body = names[i];
    adopt_annotations(state.annotations, state.motion.rate.hz, out);
    add_remarks(run->files.remarks, run->rendered.reports, out);
    out.motion = std::move(state.motion);
    out.uncertainty = std::move(state.uncertainty);
    all.push_back(std::move(out));
  }
  return all;
}

}  // namespace marey::app
