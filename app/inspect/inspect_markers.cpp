// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/inspect/inspect_markers.h"

#include <string>
#include <vector>

#include "core/base/extension.h"
#include "reconstruct/labels/name_markers.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/force_plates.h"
#include "recordings/markers/marker_file.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json events_json(const std::vector<recordings::MarkerEvent>& events) {
  Json list = Json::array();
  for (const recordings::MarkerEvent& event : events) {
    list.push_back({{"label", event.label},
                    {"context", event.context},
                    {"subject", event.subject},
                    {"time_s", event.time_s}});
  }
  return list;
}

Json plates_json(const recordings::ForcePlates& plates) {
  Json list = Json::array();
  for (const recordings::ForcePlate& plate : plates.plates) {
    double greatest_newton = 0.0;
    for (const recordings::PlateSample& sample : plate.samples) {
      greatest_newton = std::max(greatest_newton, sample.force_in_world.y);
    }
    Json corners = Json::array();
    for (const glm::dvec3& corner : plate.corners_in_world) {
      corners.push_back(vector_json(corner));
    }
    list.push_back({{"type", plate.type},
                    {"rate_hz", plates.rate.hz},
                    {"greatest_upward_force_N", greatest_newton},
                    {"corners_in_world_m", corners}});
  }
  return list;
}

const char* processor_name(recordings::C3dProcessor processor) {
  switch (processor) {
    case recordings::C3dProcessor::kIntel:
      return "intel";
    case recordings::C3dProcessor::kDec:
      return "dec";
    case recordings::C3dProcessor::kMips:
      return "mips";
  }
  return "";
}

/// Adds the details of a C3D: its number format, and its content other than markers.
Status add_c3d(const std::filesystem::path& file,
               const recordings::FileAxes& axes,
               Json& out,
               Json& notes) {
  const auto reader = recordings::C3dReader::open(file);
  if (!reader) return reader.error();
  const recordings::C3dInfo& info = reader->info();
  const bool is_real = info.numbers == recordings::C3dNumbers::kReal;
  out["processor"] = processor_name(info.processor);
  out["numbers"] = is_real ? "real" : "integer";
  const auto labels = recordings::texts_of_all(info.groups, "ANALOG", "LABELS");
  const auto units = recordings::texts_of_all(info.groups, "ANALOG", "UNITS");
  Json channels = Json::array();
  for (std::size_t c = 0; c < static_cast<std::size_t>(info.analog_channels); ++c) {
    channels.push_back({{"label", c < labels.size() ? labels[c] : ""},
                        {"unit", c < units.size() ? units[c] : ""}});
  }
  out["analog"] = {{"rate_hz", info.rate_hz * info.analog_per_frame},
                   {"channels", channels}};
  const auto plates = recordings::read_force_plates(file, axes);
  if (!plates) return plates.error();
  out["force_plates"] = plates_json(*plates);
  for (const std::string& note : plates->notes) notes.push_back(note);
  return Done{};
}

}  // namespace

Result<Json> inspect_markers(const std::filesystem::path& file) {
  const auto read = recordings::read_markers(file);
  if (!read) return read.error();
  const MarkerTracks& tracks = read->tracks;
  std::vector<std::size_t> seen(tracks.markers(), 0);
  std::size_t repaired = 0;
  std::size_t all_seen = 0;
  for (std::size_t i = 0; i < tracks.samples.size(); ++i) {
    if (!tracks.samples[i]) continue;
    ++seen[i % tracks.markers()];
    ++all_seen;
    if (tracks.samples[i]->source != Source::kMeasured) ++repaired;
  }
  const double samples = static_cast<double>(tracks.samples.size());
  const reconstruct::MarkerNames names = reconstruct::name_markers(tracks.labels);
  Json markers = Json::array();
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    const reconstruct::Landmark* landmark = names.landmarks[m];
    markers.push_back({{"label", tracks.labels[m]},
                       {"landmark", landmark ? Json(landmark->name) : Json()},
                       {"seen_frames", seen[m]}});
  }
  const bool is_c3d = kind_by_extension(file) == ".c3d";
  Json notes = read->notes;
  Json out{{"kind", is_c3d ? "c3d" : "trc"},
           {"frames", tracks.frames()},
           {"first_frame", tracks.first_frame},
           {"rate_hz", tracks.rate.hz},
           {"start_s", tracks.start_s},
           {"duration_s", static_cast<double>(tracks.frames()) / tracks.rate.hz},
           {"unit", read->axes.unit},
           {"unit_from", recordings::name(read->axes.unit_from)},
           {"up", recordings::name(read->axes.up)},
           {"up_from", recordings::name(read->axes.up_from)},
           {"seen_percent",
            samples == 0.0 ? 0.0 : 100.0 * static_cast<double>(all_seen) / samples},
           {"repaired_samples", repaired},
           {"label_set", names.set.empty() ? Json() : Json(names.set)},
           {"markers", markers},
           {"events", events_json(read->events)}};
  if (is_c3d) {
    if (Status ok = add_c3d(file, read->axes, out, notes); !ok) return ok.error();
  }
  out["notes"] = notes;
  return out;
}

}  // namespace marey::app
