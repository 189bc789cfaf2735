// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "reconstruct/labels/apply_map.h"

namespace marey::app {
namespace {

using reconstruct::Landmark;
using reconstruct::NamedMarker;

// Right labels had a places_off() of 0.6 to 1.4 in recordings of twenty laboratories, and
// labels with left and right exchanged 1.5 to 4. The distances of markers from the fitted
// body often do not differ. Above the first limit the mirrored labels are tested; they
// are accepted if their value is smaller by the second factor.
constexpr double kTypicalPlacesOff = 1.4;
constexpr double kFarBetter = 0.75;

const Landmark* mirrored(const Landmark* landmark) {
  if (landmark == nullptr) return nullptr;
  constexpr std::string_view kLeft = "left_";
  constexpr std::string_view kRight = "right_";
  const std::string_view name = landmark->name;
  std::string other(name);
  if (name.starts_with(kLeft)) {
    other = std::string(kRight).append(name.substr(kLeft.size()));
  } else if (name.starts_with(kRight)) {
    other = std::string(kLeft).append(name.substr(kRight.size()));
  }
  const Landmark* found = reconstruct::find_landmark(other);
  return found != nullptr ? found : landmark;
}

std::string some_of(std::span<const std::string> labels) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, labels.size()); ++i) {
    text.append(i > 0 ? ", " : "").append("\"").append(labels[i]).append("\"");
  }
  return labels.size() > kShown ? text + ", ..." : text;
}

/// Returns the distances of the markers from the average places of their landmarks,
/// divided by the standard deviation between people: the median over markers whose
/// landmark has a place. nullopt: there are none.
std::optional<double> places_off(const reconstruct::MarkersFit& fit,
                                 std::span<const NamedMarker> labels) {
  std::vector<double> off;
  for (const PlacedMarker& marker : fit.body.markers) {
    for (const NamedMarker& label : labels) {
      const Landmark* landmark = label.landmark;
      if (label.label != marker.label || landmark == nullptr) continue;
      if (landmark->segment != marker.segment ||
          landmark->sigma_per_stature >= reconstruct::kSomewhereSigma) {
        continue;
      }
      const double stature_m = fit.body.stature_m;
      off.push_back(glm::distance(marker.p_in_segment,
                                  stature_m * landmark->p_in_segment_per_stature) /
                    (std::sqrt(3.0) * stature_m * landmark->sigma_per_stature));
    }
  }
  if (off.empty()) return std::nullopt;
  std::sort(off.begin(), off.end());
  return off[off.size() / 2];
}

Error exchanged_error() {
  return bad_input("",
                   "left and right seem exchanged: no body fits these markers with their "
                   "labels, and one does with left and right exchanged",
                   "correct left and right, in the recording or with --markers MAP.toml");
}

/// Ignores prefixes that the labels of the map have in common with those of the files.
void drop_prefix(std::span<const std::string> prefixes,
                 std::span<const std::string> labels,
                 MarkerMapEntry& entry) {
  if (std::find(labels.begin(), labels.end(), entry.label) != labels.end()) return;
  for (const std::string& prefix : prefixes) {
    if (!entry.label.starts_with(prefix)) continue;
    const std::string rest = entry.label.substr(prefix.size());
    if (std::find(labels.begin(), labels.end(), rest) == labels.end()) continue;
    entry.label = rest;
    return;
  }
}

}  // namespace

std::vector<NamedMarker> used_labels(const FitLabels& labels) {
  std::vector<NamedMarker> used;
  for (std::size_t i = 0; i < labels.labels.size(); ++i) {
    const auto& ignored = labels.names.is_ignored;
    if ((!ignored.empty() && ignored[i]) || labels.names.is_computed[i]) continue;
    used.push_back({labels.labels[i], labels.names.landmarks[i]});
  }
  return used;
}

Result<FitLabels> name_labels(std::span<const MarkerTracks> trials,
                              std::span<const std::string> prefixes,
                              const std::optional<MarkerMap>& map) {
  FitLabels out;
  std::map<std::string, std::size_t> places;
  for (const MarkerTracks& tracks : trials) {
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      const auto [at, is_new] = places.try_emplace(tracks.labels[m], out.labels.size());
      if (is_new) {
        out.labels.push_back(tracks.labels[m]);
        out.samples.push_back(0);
      }
      for (std::size_t f = 0; f < tracks.frames(); ++f) {
        if (tracks.at(f, m)) ++out.samples[at->second];
      }
    }
  }
  out.names = reconstruct::name_markers(out.labels);
  out.names.notes.clear();  // Already printed for every file.
  if (map) {
    MarkerMap bare = *map;
    for (MarkerMapEntry& entry : bare.entries) drop_prefix(prefixes, out.labels, entry);
    auto names = reconstruct::apply_map(bare, out.labels, std::move(out.names));
    if (!names) return names.error();
    out.names = std::move(*names);
  }
  const auto& landmarks = out.names.landmarks;
  if (std::any_of(landmarks.begin(), landmarks.end(), [](const auto* l) { return l; })) {
    return out;
  }
  return bad_input("",
                   "no label is known: " + some_of(out.labels),
                   "give their meaning with --markers MAP.toml (docs/formats/markers.md, "
                   "\"Marker map\")");
}

Result<LabelledFit> fit_subject_to(const reconstruct::MarkerSubject& subject,
                                   std::span<const MarkerTracks> trials,
                                   const FitLabels& labels,
                                   const Progress& progress) {
  std::vector<NamedMarker> markers = used_labels(labels);
  auto fit = reconstruct::fit_markers(subject, trials, markers, progress);
  LabelledFit out;
  if (fit) {
    const auto off = places_off(*fit, markers);
    out.places_off = off.value_or(0.0);
    out.fit = std::move(*fit);
    if (!off || *off < kTypicalPlacesOff) return out;
  }
  for (NamedMarker& marker : markers) marker.landmark = mirrored(marker.landmark);
  const auto mirror = reconstruct::fit_markers(subject, trials, markers);
  const auto mirror_off = mirror ? places_off(*mirror, markers) : std::optional<double>();
  if (!fit) {
    if (mirror_off && *mirror_off < kTypicalPlacesOff) return exchanged_error();
    return fit.error();
  }
  if (mirror_off && *mirror_off < kFarBetter * out.places_off &&
      mirror->rms_m < out.fit.rms_m) {
    out.mirrored_places_off = *mirror_off;
  }
  return out;
}

}  // namespace marey::app
