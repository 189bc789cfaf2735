// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/marker_history.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using reconstruct::FaultySamples;
using reconstruct::GapRepair;
using reconstruct::RepairMethod;
using reconstruct::TrackFault;

// Maximum number of companion markers named for a gap.
constexpr std::size_t kMaxCarriers = 4;

SampleFate fate_of(RepairMethod method) {
  switch (method) {
    case RepairMethod::kCluster:
      return SampleFate::kCluster;
    case RepairMethod::kStructure:
      return SampleFate::kStructure;
    case RepairMethod::kSpline:
      return SampleFate::kSpline;
    case RepairMethod::kLeftEmpty:
      return SampleFate::kLeftEmpty;
  }
  return SampleFate::kLeftEmpty;
}

void mark_findings(const Repair& repair, MarkerHistory& history) {
  const std::size_t markers = history.after.markers();
  for (const FaultySamples& finding : repair.checked.findings) {
    const bool is_exchange = finding.fault == TrackFault::kExchanged;
    for (std::size_t f = finding.first; f < finding.first + finding.frames; ++f) {
      const std::size_t at = f * markers + finding.marker;
      if (!is_exchange) {
        history.is_removed[at] = true;
        continue;
      }
      history.fates[at] = SampleFate::kExchanged;
      if (finding.other) {
        history.fates[f * markers + *finding.other] = SampleFate::kExchanged;
      }
    }
  }
}

/// Frames [first, end) of one marker with the same fate.
struct Run {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// Returns the first run at or after `from` that differs from the samples read.
Run next_run(const MarkerHistory& history, std::size_t marker, std::size_t from) {
  const std::size_t frames = history.after.frames();
  while (from < frames && history.fate(from, marker) == SampleFate::kMeasured) ++from;
  Run run{from, from};
  while (run.end < frames &&
         history.fate(run.end, marker) == history.fate(run.first, marker)) {
    ++run.end;
  }
  return run;
}

const GapRepair* gap_at(const Repair& repair, std::size_t marker, std::size_t frame) {
  // Sorted by marker, then frame: finds the last gap that begins at or before it.
  const auto& gaps = repair.repaired.gaps;
  const auto after = std::upper_bound(
      gaps.begin(),
      gaps.end(),
      std::pair(marker, frame),
      [](const auto& p, const auto& g) { return p < std::pair(g.marker, g.first); });
  if (after == gaps.begin()) return nullptr;
  const GapRepair& gap = *std::prev(after);
  return gap.marker == marker && frame < gap.first + gap.frames ? &gap : nullptr;
}

Json run_json(const Repair& repair,
              const MarkerHistory& history,
              std::size_t marker,
              const Run& run) {
  const SampleFate fate = history.fate(run.first, marker);
  Json out{run.first, run.end - run.first, static_cast<int>(fate)};
  if (fate == SampleFate::kExchanged || fate == SampleFate::kLeftEmpty) return out;
  std::vector<double> sigmas_m;
  for (std::size_t f = run.first; f < run.end; ++f) {
    const auto& sample = history.after.at(f, marker);
    if (sample) sigmas_m.push_back(static_cast<double>(sample->sigma_m));
  }
  if (sigmas_m.empty()) return out;
  out.push_back(rounded(1e3 * median(sigmas_m), 2));
  out.push_back(rounded(1e3 * *std::max_element(sigmas_m.begin(), sigmas_m.end()), 2));
  const GapRepair* gap =
      fate == SampleFate::kPredicted ? nullptr : gap_at(repair, marker, run.first);
  if (gap == nullptr) return out;
  Json carriers = Json::array();
  for (const std::size_t carrier : gap->carried_by) {
    if (carriers.size() < kMaxCarriers) carriers.push_back(carrier);
  }
  out.push_back(std::move(carriers));
  return out;
}

Json marker_timeline(const Repair& repair,
                     const MarkerHistory& history,
                     std::size_t marker) {
  std::array<std::size_t, kSampleFateCount> counts{};
  for (std::size_t f = 0; f < history.after.frames(); ++f) {
    ++counts[static_cast<std::size_t>(history.fate(f, marker))];
  }
  Json runs = Json::array();
  for (Run run = next_run(history, marker, 0); run.first < run.end;
       run = next_run(history, marker, run.end)) {
    runs.push_back(run_json(repair, history, marker, run));
  }
  Json faults = Json::array();
  for (const FaultySamples& finding : repair.checked.findings) {
    const bool is_other = finding.other == marker;
    if (finding.marker != marker && !is_other) continue;
    Json fault{finding.first,
               finding.frames,
               name(finding.fault),
               rounded(1e3 * std::min(finding.off_m, 1e6), 1)};
    if (finding.other) fault.push_back(is_other ? finding.marker : *finding.other);
    faults.push_back(std::move(fault));
  }
  return {{"label", history.after.labels[marker]},
          {"counts", counts},
          {"runs", runs},
          {"faults", faults}};
}

}  // namespace

std::string_view name(SampleFate fate) {
  switch (fate) {
    case SampleFate::kMeasured:
      return "measured";
    case SampleFate::kExchanged:
      return name(TrackFault::kExchanged);
    case SampleFate::kCluster:
      return name(RepairMethod::kCluster);
    case SampleFate::kStructure:
      return name(RepairMethod::kStructure);
    case SampleFate::kSpline:
      return name(RepairMethod::kSpline);
    case SampleFate::kPredicted:
      return "predicted";
    case SampleFate::kLeftEmpty:
      return name(RepairMethod::kLeftEmpty);
  }
  return "";
}

MarkerHistory history_of(const Repair& repair, MarkerTracks after) {
  const auto& repaired = repair.repaired.tracks.samples;
  MAREY_ASSERT(after.samples.size() == repaired.size());
  MAREY_ASSERT(repair.as_read.samples.size() == repaired.size());
  MarkerHistory out;
  out.after = std::move(after);
  out.fates.resize(repaired.size(), SampleFate::kMeasured);
  out.is_removed.resize(repaired.size(), false);
  mark_findings(repair, out);
  const std::size_t markers = out.after.markers();
  for (const GapRepair& gap : repair.repaired.gaps) {
    for (std::size_t f = gap.first; f < gap.first + gap.frames; ++f) {
      out.fates[f * markers + gap.marker] = fate_of(gap.method);
    }
  }
  for (std::size_t i = 0; i < repaired.size(); ++i) {
    if (repaired[i]) continue;
    out.fates[i] = out.after.samples[i] ? SampleFate::kPredicted : SampleFate::kLeftEmpty;
  }
  return out;
}

Json timeline_json(const Repair& repair, const MarkerHistory& history) {
  Json markers = Json::array();
  for (std::size_t m = 0; m < history.after.markers(); ++m) {
    markers.push_back(marker_timeline(repair, history, m));
  }
  return markers;
}

}  // namespace marey::app
