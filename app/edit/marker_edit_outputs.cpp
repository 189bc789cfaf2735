// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/marker_edit_outputs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/edit/edit_json.h"
#include "app/edit/marker_edit_events.h"
#include "core/base/format_text.h"
#include "recordings/base/atomic_file.h"
#include "recordings/edit/annotations_file.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using MarkerJson = nlohmann::ordered_json;

/// Returns the largest acceleration of a marker over three consecutive frames. [m/s^2]
double peak_marker_acceleration(const MarkerTracks& tracks) {
  double peak = 0.0;
  for (std::size_t t = 2; t < tracks.frames(); ++t) {
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      const auto& a = tracks.at(t - 2, m);
      const auto& b = tracks.at(t - 1, m);
      const auto& c = tracks.at(t, m);
      if (!a || !b || !c) continue;
      peak = std::max(peak,
                      glm::length(c->p_in_world - 2.0 * b->p_in_world + a->p_in_world));
    }
  }
  return peak * tracks.rate.hz * tracks.rate.hz;
}

double largest_displacement_mm(const edit::RenderedMarkers& rendered) {
  double largest = 0.0;
  for (const edit::OpReport& report : rendered.reports) {
    for (const auto& [figure, value] : report.figures) {
      if (figure == "displaced_mm") largest = std::max(largest, value);
    }
  }
  return largest;
}

/// Returns the formats that are written.
std::vector<MarkerFormat> formats_of(const EditOutput& output) {
  if (!output.marker_formats.empty()) return output.marker_formats;
  return {MarkerFormat::kC3d, MarkerFormat::kTrc};
}

/// Relation of a result to the C3D of its source.
struct KeptContent {
  std::optional<std::size_t> first;  ///< Frame of the source; nullopt: nothing is kept.
  std::string reason;                ///< Why nothing is kept.
};

KeptContent kept_content(const MarkerEditFiles& files, const edit::MarkerState& state) {
  if (!files.c3d) return {std::nullopt, "the source is another recipe"};
  if (state.is_moved) return {std::nullopt, "an operation moved the markers"};
  const auto& frames = state.lineage.frames;
  const double first = frames.front().source_frame;
  bool is_part =
      state.tracks.rate.hz == files.source.tracks.rate.hz && first == std::floor(first);
  for (std::size_t t = 0; is_part && t < frames.size(); ++t) {
    is_part = frames[t].source_frame == first + static_cast<double>(t);
  }
  if (!is_part) {
    return {std::nullopt, "its frames are not consecutive frames of the source"};
  }
  return {static_cast<std::size_t>(first), ""};
}

recordings::MarkerFile file_of(const MarkerEditFiles& files,
                               const edit::MarkerState& state) {
  recordings::MarkerFile out;
  out.tracks = state.tracks;
  out.axes = files.axes;
  out.events = marker_events_of(state, files.events);
  return out;
}

/// Writes the files of one result.
class MarkerWriter {
 public:
  MarkerWriter(const MarkerEditFiles& files,
               const edit::MarkerState& state,
               fs::path stem)
      : files_(files), state_(state), stem_(std::move(stem)) {}

  Result<std::vector<fs::path>> write(const std::vector<MarkerFormat>& formats) const {
    const recordings::MarkerFile file = file_of(files_, state_);
    std::vector<fs::path> out;
    for (const MarkerFormat format : formats) {
      const fs::path path = stem_.string() + "." + std::string(name(format));
      const Status ok = recordings::write_markers(path, file, options_for(format));
      if (!ok) return ok.error();
      out.push_back(path);
    }
    const fs::path notes = stem_.string() + ".annotations.json";
    const Status ok = recordings::write_annotations(notes, state_.annotations);
    if (!ok) return ok.error();
    out.push_back(notes);
    return out;
  }

 private:
  [[nodiscard]] recordings::MarkerWriteOptions options_for(MarkerFormat format) const {
    recordings::MarkerWriteOptions out;
    if (format == MarkerFormat::kTrc) {
      // A TRC does not store the up axis; readers assume Y up.
      if (files_.is_from_c3d) {
        out.axes = files_.axes;
        out.axes->up = recordings::FileAxis::kPlusY;
      }
      return out;
    }
    const KeptContent kept = kept_content(files_, state_);
    if (!kept.first) return out;
    out.source = files_.c3d;
    out.source_first = kept.first;
    out.state_axes = true;
    return out;
  }

  const MarkerEditFiles& files_;
  const edit::MarkerState& state_;
  fs::path stem_;
};

std::string content_text(const OtherC3dContent& other) {
  std::string out;
  const auto add = [&](int count, const char* one, const char* many) {
    if (count == 0) return;
    out += (out.empty() ? "" : ", ") + std::to_string(count) + " " +
           (count == 1 ? one : many);
  };
  add(other.analog_channels, "analog channel", "analog channels");
  add(other.force_plates, "force plate", "force plates");
  add(other.points, "point that is no marker", "points that are no markers");
  return out + (out.empty() ? "the parameters" : " and the parameters");
}

}  // namespace

std::vector<EditFigures> measure_marker_edit(const EditRecipe& recipe,
                                             const MarkerEditFiles& files,
                                             const edit::RenderedMarkers& rendered) {
  const double source_peak = peak_marker_acceleration(files.source.tracks);
  const auto names = edit_names(recipe, rendered.outputs.size());
  std::vector<EditFigures> out;
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    const edit::MarkerState& state = rendered.outputs[i];
    EditFigures figures;
    figures.name = names[i];
    figures.frames = state.frame_count();
    figures.duration_s = state.duration_s();
    figures.displaced_mm = largest_displacement_mm(rendered);
    if (source_peak > 0.0) {
      figures.acceleration_ratio = peak_marker_acceleration(state.tracks) / source_peak;
    }
    const auto& frames = state.lineage.frames;
    figures.inferred_frames = static_cast<int>(
        std::count_if(frames.begin(), frames.end(), [](const edit::FrameLineage& frame) {
          return frame.trust == Source::kInferred;
        }));
    out.push_back(std::move(figures));
  }
  return out;
}

std::vector<Finding> assess_marker_content(const EditRecipe& recipe,
                                           const MarkerEditFiles& files,
                                           const edit::RenderedMarkers& rendered,
                                           const EditOutput& output) {
  const auto formats = formats_of(output);
  const bool has_c3d =
      std::find(formats.begin(), formats.end(), MarkerFormat::kC3d) != formats.end();
  const auto names = edit_names(recipe, rendered.outputs.size());
  std::vector<Finding> out;
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    const edit::MarkerState& state = rendered.outputs[i];
    const KeptContent kept = kept_content(files, state);
    const bool is_lost = files.is_from_c3d &&
                         (has_c3d ? !kept.first.has_value() : !files.other.is_empty());
    if (is_lost) {
      out.push_back(fair_finding(
          "content",
          names[i],
          content_text(files.other) + " are not in the results: " +
              (has_c3d ? kept.reason : "a TRC holds markers only"),
          has_c3d ? "take them from the source; cut, keep and split at whole frames, "
                    "filter and annotations keep them"
                  : "write a C3D, too (--format c3d)"));
    }
    constexpr std::size_t kMaxC3dEvents = 255;
    const std::size_t events = marker_events_of(state, files.events).size();
    if (events == 0 || (has_c3d && events <= kMaxC3dEvents)) continue;
    out.push_back(fair_finding(
        "events",
        names[i],
        has_c3d ? format_text("a C3D holds 255 events; the last %zu are not in it",
                              events - kMaxC3dEvents)
                : format_text("a TRC holds no events; %zu are not in it", events),
        "they are in " + names[i] + ".annotations.json"));
  }
  return out;
}

MarkerJson marker_edit_json(const EditRecipe& recipe,
                            const MarkerEditFiles& files,
                            const edit::RenderedMarkers& rendered,
                            const std::vector<EditFigures>& figures) {
  const EditSource& source = recipe.sources.front();
  MarkerJson sources = MarkerJson::array();
  sources.push_back(
      {{"id", source.id}, {"path", source.path}, {"sha256", files.sha256.substr(0, 64)}});
  MarkerJson operations = MarkerJson::array();
  for (const edit::OpReport& report : rendered.reports) {
    operations.push_back(edit_report_json(report));
  }
  MarkerJson results = MarkerJson::array();
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    const edit::MarkerState& state = rendered.outputs[i];
    const MarkerJson all = edit_figures_json(figures[i]);
    MarkerJson result;
    for (const char* key : {"name", "frames", "duration_s"}) result[key] = all.at(key);
    result["markers"] = state.tracks.markers();
    for (const char* key : {"displaced_mm", "acceleration_ratio", "inferred_frames"}) {
      result[key] = all.at(key);
    }
    result["keeps_other_content"] = kept_content(files, state).first.has_value();
    result["lineage"] = edit_lineage_json(state.lineage);
    results.push_back(std::move(result));
  }
  return {{"format", 1},
          {"name", recipe.name},
          {"sources", sources},
          {"operations", operations},
          {"results", results}};
}

Result<std::vector<fs::path>> write_marker_edit(const EditRecipe& recipe,
                                                const MarkerEditFiles& files,
                                                const edit::RenderedMarkers& rendered,
                                                const std::vector<EditFigures>& figures,
                                                const EditOutput& output) {
  const auto names = edit_names(recipe, rendered.outputs.size());
  std::vector<std::string> endings;
  for (const MarkerFormat format : formats_of(output)) {
    endings.push_back("." + std::string(name(format)));
  }
  const Status spared = check_no_overwrite(output, files.paths, names, endings);
  if (!spared) return spared.error();
  std::vector<fs::path> out;
  for (std::size_t i = 0; i < rendered.outputs.size(); ++i) {
    const MarkerWriter writer(files, rendered.outputs[i], output.out / names[i]);
    auto written = writer.write(formats_of(output));
    if (!written) return written.error();
    std::move(written->begin(), written->end(), std::back_inserter(out));
  }
  constexpr auto kReplace = MarkerJson::error_handler_t::replace;
  const std::string text =
      marker_edit_json(recipe, files, rendered, figures).dump(1, ' ', false, kReplace) +
      "\n";
  const fs::path json = output.out / (recipe.name + ".edit.json");
  if (const Status ok = recordings::write_file(json, text); !ok) return ok.error();
  out.push_back(json);
  return out;
}

}  // namespace marey::app
