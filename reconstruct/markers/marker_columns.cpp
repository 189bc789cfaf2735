// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_columns.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {
namespace {

// Minimum stray of a marker: smaller measured values are not trusted. [m]
constexpr double kMinKnownStray_m = 0.001;

bool is_finite(const MarkerSample& sample) {
  const glm::dvec3& p = sample.p_in_world;
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
         std::isfinite(sample.sigma_m);
}

}  // namespace

MarkerModel to_marker_model(const Body& body) {
  MarkerModel model;
  model.lengths = lengths_of(body.proportions);
  model.body = body_constants(body);
  for (const PlacedMarker& marker : body.markers) {
    const HumanBone bone = solved_segment(marker.segment);
    glm::dvec3 p = marker.p_in_segment;
    // Toes move with their foot, in whose frame their origin is further forward.
    if (bone != marker.segment) p += body.proportions[marker.segment];
    model.markers.push_back({bone, eigen(p), std::max(kMinKnownStray_m, marker.stray_m)});
  }
  return model;
}

MarkerColumns find_columns(const Body& body, std::span<const std::string> labels) {
  MarkerColumns columns;
  for (const PlacedMarker& marker : body.markers) {
    const auto it = std::find(labels.begin(), labels.end(), marker.label);
    columns.push_back(it == labels.end()
                          ? std::nullopt
                          : std::optional(static_cast<std::size_t>(it - labels.begin())));
  }
  return columns;
}

void collect(std::span<const std::optional<MarkerSample>> frame,
             const MarkerColumns& columns,
             std::vector<SeenMarker>& out) {
  out.clear();
  for (std::size_t m = 0; m < columns.size(); ++m) {
    if (!columns[m] || !frame[*columns[m]]) continue;
    const MarkerSample& sample = *frame[*columns[m]];
    if (!is_finite(sample)) continue;
    out.push_back({m, eigen(sample.p_in_world), static_cast<double>(sample.sigma_m)});
  }
}

BoneSources sources_of(const MarkerModel& model,
                       std::span<const std::optional<MarkerSample>> frame,
                       const MarkerColumns& columns) {
  BoneSources sources;
  sources.fill(Source::kInferred);
  for (std::size_t m = 0; m < columns.size(); ++m) {
    if (!columns[m] || !frame[*columns[m]]) continue;
    Source& source = sources[index(model.markers[m].bone)];
    source = std::min(source, frame[*columns[m]]->source);
  }
  sources[index(HumanBone::kLeftToes)] = sources[index(HumanBone::kLeftFoot)];
  sources[index(HumanBone::kRightToes)] = sources[index(HumanBone::kRightFoot)];
  return sources;
}

}  // namespace marey::reconstruct
