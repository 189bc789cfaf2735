// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "edit/markers/apply_marker_op.h"
#include "edit/markers/marker_state.h"
#include <glm/geometric.hpp>

#include "tests/support/bodies/random_bodies.h"

namespace marey::edit {

/// One operation on markers, with its report.
struct MarkerScene {
  EditOp op;
  OpReport report;

  explicit MarkerScene(EditOpParameters parameters) {
    op.parameters = std::move(parameters);
  }

  [[nodiscard]] Result<std::vector<MarkerState>> run_all(const MarkerState& state) {
    report = {};
    return apply_marker_op({op, 0}, state, report);
  }
  [[nodiscard]] Result<MarkerState> run(const MarkerState& state) {
    auto made = run_all(state);
    if (!made) return made.error();
    return made->front();
  }
  /// Returns a figure of the report; NaN if it is missing.
  [[nodiscard]] double figure(std::string_view name) const {
    for (const auto& [key, value] : report.figures) {
      if (key == name) return value;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] bool has_finding(std::string_view id) const {
    for (const Finding& finding : report.findings) {
      if (finding.id == id) return true;
    }
    return false;
  }
};

/// Returns the place of a made marker: it travels along +Z and swings, each marker with
/// its own frequency up to 4 Hz.
[[nodiscard]] inline glm::dvec3 made_place(std::size_t marker, double time_s) {
  const double k = static_cast<double>(marker);
  const double w = 2.0 * std::numbers::pi * (1.0 + 0.5 * k);
  return {0.1 * k + 0.05 * std::sin(w * time_s + k),
          1.0 + 0.2 * k + 0.04 * std::cos(1.1 * w * time_s),
          1.2 * time_s + 0.06 * std::sin(0.9 * w * time_s + 2.0 * k)};
}

/// Returns made markers without noise: LASI, RASI, LKNE, RKNE, C7, SACR.
[[nodiscard]] inline MarkerTracks made_tracks(int frames = 360, double hz = 120.0) {
  MarkerTracks out;
  out.labels = {"LASI", "RASI", "LKNE", "RKNE", "C7", "SACR"};
  out.rate = FrameRate{hz};
  out.first_frame = 31;
  out.start_s = 30.0 / hz;
  for (int t = 0; t < frames; ++t) {
    for (std::size_t m = 0; m < out.markers(); ++m) {
      MarkerSample sample;
      sample.p_in_world = made_place(m, t / hz);
      sample.sigma_m = 0.0004F;
      sample.cameras = 0x15;
      out.samples.emplace_back(sample);
    }
  }
  return out;
}

/// Adds white noise to each coordinate.
inline void add_marker_noise(MarkerTracks& tracks, std::uint64_t seed, double sigma_m) {
  testing::Dice dice(seed);
  for (auto& sample : tracks.samples) {
    if (!sample) continue;
    sample->p_in_world +=
        glm::dvec3(dice.noise(sigma_m), dice.noise(sigma_m), dice.noise(sigma_m));
  }
}

/// Removes the samples of one marker from `first` to `last`.
inline void make_gap(MarkerTracks& tracks, std::size_t marker, int first, int last) {
  for (int t = first; t <= last; ++t) {
    tracks.at(static_cast<std::size_t>(t), marker).reset();
  }
}

/// Returns the root mean square distance of one marker from its true place, over frames
/// in which it is seen. Frame 0 is at time 0 of made_place().
[[nodiscard]] inline double made_error_m(const MarkerTracks& tracks, std::size_t marker) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t < tracks.frames(); ++t) {
    const auto& sample = tracks.at(t, marker);
    if (!sample) continue;
    const glm::dvec3 apart =
        sample->p_in_world - made_place(marker, static_cast<double>(t) / tracks.rate.hz);
    squares += glm::dot(apart, apart);
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

/// Returns true if both have the same samples, to the bit.
[[nodiscard]] inline bool same_samples(const MarkerTracks& a, const MarkerTracks& b) {
  if (a.labels != b.labels || a.samples.size() != b.samples.size()) return false;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    if (a.samples[i].has_value() != b.samples[i].has_value()) return false;
    if (!a.samples[i]) continue;
    if (a.samples[i]->p_in_world != b.samples[i]->p_in_world ||
        a.samples[i]->sigma_m != b.samples[i]->sigma_m ||
        a.samples[i]->cameras != b.samples[i]->cameras ||
        a.samples[i]->source != b.samples[i]->source) {
      return false;
    }
  }
  return true;
}

}  // namespace marey::edit
