// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/marker_edit_inputs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "edit/markers/render_markers.h"

#include "app/markers/marker_event_text.h"
#include "core/base/extension.h"
#include "core/base/printable.h"
#include "recordings/base/sha256.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxMarkerRecipesDeep = 16;

bool is_marker_file(const fs::path& file) {
  return recordings::check_marker_extension(file).has_value();
}

bool has_markers_below(const EditRecipe& recipe,
                       const ReadEditOptions& options,
                       int depth) {
  if (recipe.sources.empty() || depth > kMaxMarkerRecipesDeep) return false;
  const std::string& path = recipe.sources.front().path;
  if (is_marker_file(path)) return true;
  if (!path.ends_with(".edit.toml")) return false;
  const auto file = find_edit_file(options, path);
  if (!file) return false;
  const auto inner = recordings::read_edit_recipe(*file);
  if (!inner) return false;
  return has_markers_below(
      *inner, {file->parent_path(), file->string(), false}, depth + 1);
}

/// Adds the events of a file as annotations.
void adopt_events(const recordings::MarkerFile& file,
                  const std::string& name,
                  MarkerEditFiles& out) {
  std::set<std::string> subjects;
  for (const recordings::MarkerEvent& event : file.events) subjects.insert(event.subject);
  edit::MarkerState& state = out.source;
  std::size_t outside = 0;
  for (const recordings::MarkerEvent& event : file.events) {
    constexpr double kHalfFrame = 0.5;
    const double reach_s = kHalfFrame / state.tracks.rate.hz;
    const double time_s = event.time_s - state.tracks.start_s;
    if (!(time_s >= -reach_s && time_s <= state.duration_s() + reach_s)) {
      ++outside;
      continue;
    }
    std::string text = text_of_event(event);
    if (subjects.size() > 1 && !event.subject.empty()) {
      text = printable(event.subject) + ":" + text;
    }
    const double within_s = std::clamp(time_s, 0.0, state.duration_s());
    state.annotations.notes.push_back({text, within_s, within_s});
    out.events.push_back({std::move(text), event});
  }
  std::stable_sort(state.annotations.notes.begin(),
                   state.annotations.notes.end(),
                   [](const Annotation& a, const Annotation& b) {
                     return std::pair(a.start_s, a.text) < std::pair(b.start_s, b.text);
                   });
  if (outside == 0) return;
  out.remarks.push_back(name + ": " + std::to_string(outside) +
                        (outside == 1 ? " event lies" : " events lie") +
                        " outside the frames and are left out");
}

Status find_other_content(const fs::path& file, MarkerEditFiles& out) {
  if (kind_by_extension(file) != ".c3d") return Done{};
  const auto reader = recordings::C3dReader::open(file);
  if (!reader) return reader.error();
  const recordings::C3dInfo& info = reader->info();
  out.c3d = file;
  out.is_from_c3d = true;
  out.other.analog_channels = info.analog_channels;
  out.other.points = info.points - static_cast<int>(out.source.tracks.markers());
  if (const auto* used =
          recordings::find_parameter(info.groups, "FORCE_PLATFORM", "USED")) {
    const std::vector<double> count = recordings::numbers(*used);
    if (!count.empty() && count[0] > 0.0) {
      out.other.force_plates = static_cast<int>(std::lround(count[0]));
    }
  }
  return Done{};
}

Result<MarkerEditFiles> read_marker_file(const fs::path& file) {
  auto read = recordings::read_markers(file);
  if (!read) return read.error();
  MarkerEditFiles out;
  out.axes = read->axes;
  for (const std::string& note : read->notes) {
    out.remarks.push_back(file.string() + ": " + note);
  }
  auto state = edit::make_marker_state(std::move(read->tracks));
  if (!state) {
    Error error = state.error();
    error.where = file.string() + ": " + error.where;
    return error;
  }
  out.source = *std::move(state);
  adopt_events(*read, file.string(), out);
  if (const Status ok = find_other_content(file, out); !ok) return ok.error();
  return out;
}

/// Renders a recipe that is the source of another.
Result<MarkerEditFiles> render_marker_source(const fs::path& file,
                                             const ReadEditOptions& above) {
  const auto recipe = recordings::read_edit_recipe(file);
  if (!recipe) return recipe.error();
  auto files = read_marker_edit_files(
      *recipe, {file.parent_path(), file.string(), above.accept_new_sources});
  if (!files) return files.error();
  edit::RenderMarkersOptions options;
  options.recipe_file = file.string();
  auto rendered = edit::render_markers(*recipe, files->source, options);
  if (!rendered) return rendered.error();
  if (rendered->outputs.size() != 1) {
    return bad_input(file.string(),
                     "gives " + std::to_string(rendered->outputs.size()) + " recordings",
                     "use a recipe without keep and split as a source");
  }
  MarkerEditFiles out = *std::move(files);
  // Its frames are the source's own for this recipe.
  const std::vector<edit::FrameLineage> inner =
      std::move(rendered->outputs.front().lineage.frames);
  out.source = std::move(rendered->outputs.front());
  out.source.lineage = edit::lineage_of_source(0, out.source.frame_count());
  for (std::size_t t = 0; t < inner.size(); ++t) {
    out.source.lineage.frames[t].trust = inner[t].trust;
  }
  out.c3d.reset();
  return out;
}

Result<MarkerEditFiles> read_first_source(const EditSource& source,
                                          const ReadEditOptions& options) {
  const auto file = find_edit_file(options, source.path);
  if (!file) return file.error();
  const auto sha256 = recordings::sha256_of_file(*file);
  if (!sha256) return sha256.error();
  if (const Status ok = check_edit_source(source, *file, *sha256, options); !ok) {
    return ok.error();
  }
  auto out = is_marker_file(*file) ? read_marker_file(*file)
                                   : render_marker_source(*file, options);
  if (!out) return out.error();
  out->sha256 = *sha256 + out->sha256;
  out->paths.push_back(*file);
  return out;
}

}  // namespace

bool edits_markers(const EditRecipe& recipe, const ReadEditOptions& options) {
  return has_markers_below(recipe, options, 0);
}

Result<MarkerEditFiles> read_marker_edit_files(const EditRecipe& recipe,
                                               const ReadEditOptions& options) {
  if (recipe.sources.size() > 1) {
    const EditSource& second = recipe.sources[1];
    return at_recipe_line_of(
        bad_input("source " + second.id,
                  "a recipe of labelled markers has one source: markers are not joined",
                  "remove it, or solve the markers first (marey fit) and splice the "
                  "motions"),
        second.line,
        options);
  }
  auto out = read_first_source(recipe.sources.front(), options);
  if (out) return out;
  return at_recipe_line_of(out.error(), recipe.sources.front().line, options);
}

}  // namespace marey::app
