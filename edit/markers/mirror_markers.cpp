// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/mirror_markers.h"

#include <algorithm>
#include <map>

#include "edit/state/check_op_keys.h"
#include "edit/state/mirror_names.h"

namespace marey::edit {
namespace {

/// Returns labels that may be the counterpart, the most certain first.
std::vector<std::string> possible_counterparts(const std::string& label) {
  const std::size_t colon = label.rfind(':');
  const std::size_t start = colon == std::string::npos ? 0 : colon + 1;
  if (start >= label.size()) return {};
  const std::string subject = label.substr(0, start);
  const std::string own = label.substr(start);
  std::vector<std::string> out{subject + mirrored_name(own)};
  std::string changed = own;
  changed.front() = other_side_letter(own.front());
  out.push_back(subject + changed);
  changed = own;
  changed.back() = other_side_letter(own.back());
  out.push_back(subject + changed);
  return out;
}

}  // namespace

std::vector<std::optional<std::size_t>> marker_counterparts(
    std::span<const std::string> labels) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < labels.size(); ++i) places.emplace(labels[i], i);
  std::vector<std::optional<std::size_t>> out(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (const std::string& wanted : possible_counterparts(labels[i])) {
      const auto found = places.find(wanted);
      if (found == places.end() || found->second == i) continue;
      out[i] = found->second;
      break;
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] && out[*out[i]] != i) out[i].reset();
  }
  return out;
}

Result<MarkerState> mirror_markers(const MirrorOp& /*op*/,
                                   const MarkerOpContext& context,
                                   const MarkerState& state,
                                   OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {}); !ok) return ok.error();
  const auto counterpart = marker_counterparts(state.tracks.labels);
  std::vector<std::string> alone;
  for (std::size_t m = 0; m < counterpart.size(); ++m) {
    if (!counterpart[m]) alone.push_back(state.tracks.labels[m]);
  }
  if (2 * alone.size() > counterpart.size()) {
    return bad_input(
        "mirror",
        "the sides of these markers are not recognised: " + std::to_string(alone.size()) +
            " of " + std::to_string(counterpart.size()) +
            " labels have no counterpart with left and right exchanged (" +
            label_list(alone) + ")",
        "name them as LKNE and RKNE or left_knee and right_knee, or solve "
        "the markers first (marey fit) and mirror the motion");
  }
  MarkerState out = state;
  out.is_moved = true;
  for (std::size_t t = 0; t < out.tracks.frames(); ++t) {
    for (std::size_t m = 0; m < counterpart.size(); ++m) {
      auto& sample = out.tracks.at(t, m);
      sample = state.tracks.at(t, counterpart[m].value_or(m));
      if (sample) sample->p_in_world.x = -sample->p_in_world.x;
    }
  }
  for (Annotation& note : out.annotations.notes) note.text = mirrored_name(note.text);
  for (ValueCurve& curve : out.annotations.curves) {
    curve.name = mirrored_name(curve.name);
  }
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  const std::size_t pairs = (counterpart.size() - alone.size()) / 2;
  report.figures.emplace_back("pairs", static_cast<double>(pairs));
  if (!alone.empty()) {
    report.findings.push_back({Severity::kNote,
                               "no_counterpart",
                               label_list(alone),
                               "has no counterpart on the other side and keeps its label",
                               ""});
  }
  return out;
}

}  // namespace marey::edit
