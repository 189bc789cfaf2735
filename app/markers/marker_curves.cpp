// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/marker_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using reconstruct::TrackFault;

// Number of instants that a small picture can show.
constexpr std::size_t kMaxInstants = 400;
// Minimum time shown on each side of a repair.
constexpr double kMinAround_s = 0.3;
constexpr double kShareAround = 0.3;
// Larger than any room: coordinates beyond it come from a broken file. [m]
constexpr double kMaxRoom_m = 1e3;

/// Frames [first, first + frames) of a marker that were repaired.
struct Repaired {
  std::size_t marker = 0;
  std::size_t first = 0;
  std::size_t frames = 0;
  double worst_sigma_m = 0.0;
  double off_m = 0.0;  ///< Error of wrong samples.
};

bool is_filled(SampleFate fate) {
  return fate != SampleFate::kMeasured && fate != SampleFate::kExchanged &&
         fate != SampleFate::kLeftEmpty;
}

/// Returns every run of filled samples, whatever the method.
std::vector<Repaired> fills(const MarkerHistory& history) {
  std::vector<Repaired> out;
  const std::size_t frames = history.after.frames();
  for (std::size_t m = 0; m < history.after.markers(); ++m) {
    for (std::size_t f = 0; f < frames; ++f) {
      if (!is_filled(history.fate(f, m))) continue;
      Repaired run{m, f, 0, 0.0, 0.0};
      for (; f < frames && is_filled(history.fate(f, m)); ++f) {
        ++run.frames;
        const auto& sample = history.after.at(f, m);
        if (!sample) continue;
        run.worst_sigma_m =
            std::max(run.worst_sigma_m, static_cast<double>(sample->sigma_m));
      }
      out.push_back(run);
    }
  }
  return out;
}

std::vector<Repaired> wrong_samples(const Repair& repair) {
  std::vector<Repaired> out;
  for (const auto& finding : repair.checked.findings) {
    out.push_back({finding.marker, finding.first, finding.frames, 0.0, finding.off_m});
  }
  return out;
}

template <class Worse>
std::vector<Repaired> sorted(std::vector<Repaired> all, Worse worse) {
  std::stable_sort(all.begin(), all.end(), worse);
  return all;
}

std::vector<Repaired> chosen(const Repair& repair,
                             const MarkerHistory& history,
                             std::size_t max_count) {
  const std::vector<Repaired> filled = fills(history);
  const std::array<std::vector<Repaired>, 3> rankings{
      sorted(filled, [](const auto& a, const auto& b) { return a.frames > b.frames; }),
      sorted(
          filled,
          [](const auto& a, const auto& b) { return a.worst_sigma_m > b.worst_sigma_m; }),
      sorted(wrong_samples(repair),
             [](const auto& a, const auto& b) { return a.off_m > b.off_m; })};
  std::array<std::size_t, 3> next{};
  std::set<std::size_t> markers;
  std::vector<Repaired> out;
  bool is_any_left = true;
  while (out.size() < max_count && is_any_left) {
    is_any_left = false;
    for (std::size_t r = 0; r < rankings.size() && out.size() < max_count; ++r) {
      while (next[r] < rankings[r].size()) {
        const Repaired& one = rankings[r][next[r]++];
        if (!markers.insert(one.marker).second) continue;
        out.push_back(one);
        is_any_left = true;
        break;
      }
    }
  }
  return out;
}

Json coordinate_mm(const std::optional<MarkerSample>& sample, int axis) {
  if (!sample) return {};
  const double p_m = sample->p_in_world[axis];
  if (!std::isfinite(p_m) || std::abs(p_m) > kMaxRoom_m) return {};
  return rounded(1e3 * p_m, 1);
}

/// Returns the frame of [from, end) to show: a wrong sample if there is one.
std::size_t shown_frame(const MarkerHistory& history,
                        std::size_t marker,
                        std::size_t from,
                        std::size_t end) {
  for (std::size_t f = from; f < end; ++f) {
    if (history.removed(f, marker)) return f;
  }
  return from;
}

Json curve(const Repair& repair, const MarkerHistory& history, const Repaired& repaired) {
  const std::size_t m = repaired.marker;
  const std::size_t frames = history.after.frames();
  const auto around = static_cast<std::size_t>(
      std::max(kMinAround_s * history.after.rate.hz,
               kShareAround * static_cast<double>(repaired.frames)));
  const std::size_t from = repaired.first - std::min(repaired.first, around);
  const std::size_t end = std::min(frames, repaired.first + repaired.frames + around);
  const std::size_t step = (end - from + kMaxInstants - 1) / kMaxInstants;
  Json at = Json::array();
  Json read = Json::array({Json::array(), Json::array(), Json::array()});
  Json after = read;
  Json sigma = Json::array();
  Json fates = Json::array();
  Json removed = Json::array();
  for (std::size_t bucket = from; bucket < end; bucket += step) {
    const std::size_t f = shown_frame(history, m, bucket, std::min(end, bucket + step));
    const auto& sample = history.after.at(f, m);
    at.push_back(f);
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      read[i].push_back(coordinate_mm(repair.as_read.at(f, m), axis));
      after[i].push_back(coordinate_mm(sample, axis));
    }
    const bool has_sigma = sample && is_filled(history.fate(f, m));
    sigma.push_back(has_sigma
                        ? Json(rounded(1e3 * static_cast<double>(sample->sigma_m), 2))
                        : Json());
    fates.push_back(static_cast<int>(history.fate(f, m)));
    removed.push_back(history.removed(f, m) ? 1 : 0);
  }
  return {{"marker", m},
          {"first", repaired.first},
          {"frames", repaired.frames},
          {"at", at},
          {"read_mm", read},
          {"after_mm", after},
          {"sigma_mm", sigma},
          {"fates", fates},
          {"removed", removed}};
}

}  // namespace

Json repair_curves(const Repair& repair,
                   const MarkerHistory& history,
                   std::size_t max_count) {
  Json out = Json::array();
  for (const Repaired& repaired : chosen(repair, history, max_count)) {
    out.push_back(curve(repair, history, repaired));
  }
  return out;
}

}  // namespace marey::app
