// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/repair_json.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using reconstruct::FaultySamples;
using reconstruct::GapRepair;
using reconstruct::RepairMethod;

int frame_number(const MarkerTracks& tracks, std::size_t frame) {
  return tracks.first_frame + static_cast<int>(frame);
}

Json gap_json(const MarkerTracks& tracks, const GapRepair& gap) {
  Json carried_by = Json::array();
  for (const std::size_t marker : gap.carried_by)
    carried_by.push_back(tracks.labels[marker]);
  const bool filled = gap.method != RepairMethod::kLeftEmpty;
  return {
      {"marker", tracks.labels[gap.marker]},
      {"first_frame", frame_number(tracks, gap.first)},
      {"last_frame", frame_number(tracks, gap.first + gap.frames - 1)},
      {"method", name(gap.method)},
      {"carried_by", carried_by},
      {"median_sigma_mm", filled ? Json(rounded(1e3 * gap.median_sigma_m, 2)) : Json()},
      {"worst_sigma_mm", filled ? Json(rounded(1e3 * gap.worst_sigma_m, 2)) : Json()}};
}

Json finding_json(const MarkerTracks& tracks, const FaultySamples& finding) {
  return {{"fault", name(finding.fault)},
          {"marker", tracks.labels[finding.marker]},
          {"with", finding.other ? Json(tracks.labels[*finding.other]) : Json()},
          {"first_frame", frame_number(tracks, finding.first)},
          {"last_frame", frame_number(tracks, finding.first + finding.frames - 1)},
          {"off_mm", rounded(1e3 * finding.off_m, 1)}};
}

}  // namespace

Json repair_json(const Repair& repair) {
  const MarkerTracks& tracks = repair.repaired.tracks;
  Json faults = Json::array();
  for (const FaultySamples& finding : repair.checked.findings) {
    faults.push_back(finding_json(tracks, finding));
  }
  Json gaps = Json::array();
  std::size_t empty = 0;
  for (const GapRepair& gap : repair.repaired.gaps) {
    gaps.push_back(gap_json(tracks, gap));
  }
  std::size_t missing = 0;
  for (std::size_t i = 0; i < tracks.samples.size(); ++i) {
    missing += repair.as_read.samples[i] ? 0 : 1;
    empty += tracks.samples[i] ? 0 : 1;
  }
  return {{"file", repair.name},
          {"markers", tracks.markers()},
          {"frames", tracks.frames()},
          {"rate_hz", tracks.rate.hz},
          {"samples", tracks.samples.size()},
          {"samples_missing", missing},
          {"samples_left_empty", empty},
          {"faults", faults},
          {"gaps", gaps}};
}

std::string repair_table(const Repair& repair) {
  const MarkerTracks& tracks = repair.repaired.tracks;
  const std::size_t markers = tracks.markers();
  std::vector<std::string_view> words(tracks.samples.size());
  for (const FaultySamples& finding : repair.checked.findings) {
    for (std::size_t f = finding.first; f < finding.first + finding.frames; ++f) {
      words[f * markers + finding.marker] = name(finding.fault);
      if (finding.other) words[f * markers + *finding.other] = name(finding.fault);
    }
  }
  for (const GapRepair& gap : repair.repaired.gaps) {
    for (std::size_t f = gap.first; f < gap.first + gap.frames; ++f) {
      const std::size_t at = f * markers + gap.marker;
      words[at] = tracks.samples[at] ? name(gap.method) : name(RepairMethod::kLeftEmpty);
    }
  }
  std::string text = "frame,time,marker,method,sigma\n";
  std::array<char, 64> buffer{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].empty()) continue;
    const std::size_t frame = i / markers;
    std::snprintf(buffer.data(),
                  buffer.size(),
                  "%d,%.6f,",
                  frame_number(tracks, frame),
                  tracks.time_s(frame));
    text += buffer.data();
    text += tracks.labels[i % markers];
    text += ',';
    text += words[i];
    text += ',';
    if (tracks.samples[i]) {
      std::snprintf(buffer.data(),
                    buffer.size(),
                    "%.6f",
                    static_cast<double>(tracks.samples[i]->sigma_m));
      text += buffer.data();
    }
    text += '\n';
  }
  return text;
}

}  // namespace marey::app
