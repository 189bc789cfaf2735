// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Points of a C3D: selection of the markers, and conversion of a point's four words.
#include <algorithm>
#include <cmath>
#include <set>

#include "recordings/base/motion_limits.h"
#include "recordings/markers/c3d_markers.h"
#include "recordings/markers/marker_labels.h"

namespace marey::recordings {
namespace {

/// Returns the word of residual and cameras as 16 bits; nullopt if the point was not
/// seen.
std::optional<unsigned> seen_word(float word) {
  if (!std::isfinite(word) || word < 0.0F) return std::nullopt;
  // Reals are truncated to 16 bits; Qualisys writes 65535 for -1.
  const auto bits = static_cast<unsigned>(std::min(word, 65535.0F));
  if (bits > 32767U) return std::nullopt;
  return bits;
}

}  // namespace

C3dMarkers markers_of(const C3dInfo& info, std::vector<std::string>& notes) {
  std::set<std::string> results;
  for (const char* kind : {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS"}) {
    for (std::string& label : texts_of_all(info.groups, "POINT", kind)) {
      if (!label.empty()) results.insert(std::move(label));
    }
  }
  const auto points = static_cast<std::size_t>(info.points);
  const std::vector<std::string> labels = texts_of_all(info.groups, "POINT", "LABELS");
  C3dMarkers markers;
  std::vector<std::string> own;
  for (std::size_t point = 0; point < points; ++point) {
    const bool named = point < labels.size();
    if (named && results.contains(labels[point])) continue;
    markers.point.push_back(point);
    own.push_back(named ? labels[point] : "");
  }
  if (markers.point.size() < points) {
    notes.push_back(std::to_string(points - markers.point.size()) +
                    " points are angles, forces, moments, powers or scalars, and no "
                    "markers");
  }
  markers.labels = distinct_labels(std::move(own), markers.point.size(), notes);
  return markers;
}

std::optional<glm::dvec3> c3d_position(const C3dInfo& info,
                                       const float* words,
                                       bool trust_all) {
  if (!trust_all && !seen_word(words[3])) return std::nullopt;
  const double unit = info.numbers == C3dNumbers::kInteger ? info.scale : 1.0;
  const glm::dvec3 p = unit * glm::dvec3(words[0], words[1], words[2]);
  const bool is_finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  // A measurement at exactly the origin does not occur: it means "not seen".
  if (!is_finite || p == glm::dvec3(0.0)) return std::nullopt;
  return p;
}

std::optional<MarkerSample> c3d_sample(const C3dInfo& info,
                                       const FileAxes& axes,
                                       const float* words,
                                       bool trust_all) {
  const auto p = c3d_position(info, words, trust_all);
  if (!p) return std::nullopt;
  MarkerSample sample;
  sample.p_in_world = turned_to_world(axes.up, *p / axes.per_metre);
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(sample.p_in_world[i]) <= kMaxDistance_m)) return std::nullopt;
  }
  const unsigned bits = seen_word(words[3]).value_or(0U);
  sample.sigma_m =
      static_cast<float>(static_cast<double>(bits & 0xFFU) * info.scale / axes.per_metre);
  sample.cameras = static_cast<std::uint8_t>(bits >> 8U);
  return sample;
}

void put_c3d_sample(const C3dInfo& info,
                    const FileAxes& axes,
                    const std::optional<MarkerSample>& sample,
                    float* words) {
  if (!sample) {
    std::fill(words, words + 3, 0.0F);
    words[3] = -1.0F;
    return;
  }
  const glm::dvec3 p = axes.per_metre * turned_to_file(axes.up, sample->p_in_world);
  const double unit = info.numbers == C3dNumbers::kInteger ? info.scale : 1.0;
  for (int i = 0; i < 3; ++i) {
    const double word = p[i] / unit;
    words[i] = static_cast<float>(info.numbers == C3dNumbers::kInteger ? std::round(word)
                                                                       : word);
  }
  words[3] = 0.0F;
  if (sample->source != Source::kMeasured) return;
  const double steps = static_cast<double>(sample->sigma_m) * axes.per_metre / info.scale;
  double residual = std::clamp(std::round(steps), 0.0, 255.0);
  // Without residual and cameras it would be read as filled.
  if (residual == 0.0 && sample->sigma_m > 0.0F) residual = 1.0;
  words[3] = static_cast<float>(residual + 256.0 * (sample->cameras & 0x7FU));
}

bool has_rotations(const C3dInfo& info) {
  return find_parameter(info.groups, "ROTATION", "DATA_START") != nullptr;
}

Result<bool> all_marked_unseen(C3dReader reader) {
  C3dFrame frame;
  bool has_positions = false;
  for (;;) {
    const Result<bool> more = reader.next(frame);
    if (!more) return more.error();
    if (!*more) return has_positions;
    for (std::size_t word = 0; word + 3 < frame.points.size(); word += 4) {
      if (seen_word(frame.points[word + 3])) return false;
      has_positions =
          has_positions || c3d_position(reader.info(), &frame.points[word], true);
    }
  }
}

}  // namespace marey::recordings
