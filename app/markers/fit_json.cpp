// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_json.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "app/markers/assess_fit.h"
#include "app/pages/report_json.h"
#include "app/shell/findings.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using reconstruct::LabelUse;
using reconstruct::LabelVerdict;

double mm(double length_m) {
  return rounded(1e3 * length_m, 2);
}

const PlacedMarker* placed(const Body& body, const std::string& label) {
  for (const PlacedMarker& marker : body.markers) {
    if (marker.label == label) return &marker;
  }
  return nullptr;
}

const LabelVerdict* verdict(const FitRun& run, const std::string& label) {
  if (!run.subject) return nullptr;
  for (const LabelVerdict& one : run.subject->fit.labels) {
    if (one.label == label) return &one;
  }
  return nullptr;
}

Json label_json(const FitRun& run, std::size_t i) {
  const std::string& label = run.labels.labels[i];
  const auto* landmark = run.labels.names.landmarks[i];
  const PlacedMarker* marker = placed(run.body, label);
  const LabelVerdict* found = verdict(run, label);
  Json out{{"label", label},
           {"landmark", landmark != nullptr ? Json(landmark->name) : Json()},
           {"samples", run.labels.samples[i]}};
  if (marker == nullptr) {
    out["use"] = name(LabelUse::kLeftOut);
    out["why"] = why_unused(run.labels, i);
    return out;
  }
  out["use"] = found != nullptr ? name(found->use) : "given";
  out["segment"] = name(marker->segment);
  out["sigma_mm"] = mm(marker->sigma_m);
  out["stray_mm"] = mm(marker->stray_m);
  return out;
}

Json finding_json(const FitRun& run) {
  Json findings = Json::array();
  const auto add = [&](const reconstruct::FaultyLabel& one) {
    const auto trial = [&](const std::optional<std::size_t>& at) {
      return at ? Json(run.trials[*at].name) : Json();
    };
    findings.push_back({{"fault", name(one.fault)},
                        {"label", one.label},
                        {"other", one.other.empty() ? Json() : Json(one.other)},
                        {"trial", trial(one.trial)},
                        {"or_trial", trial(one.or_trial)},
                        {"off_mm", mm(one.off_m)},
                        {"exchanged_mm", mm(one.exchanged_m)}});
  };
  for (const auto& one : run.checks.of_fit) add(one);
  for (const auto& one : run.checks.of_trials) add(one);
  return findings;
}

Json joint_json(const FitRun& run) {
  Json joints = Json::array();
  for (const reconstruct::JointEvidence& joint : run.subject->fit.joints) {
    joints.push_back({{"joint", name(joint.joint)},
                      {"origin", name(joint.origin)},
                      {"sigma_mm", mm(joint.sigma_m)},
                      {"range_deg", rounded(57.29577951308232 * joint.range_rad, 1)}});
  }
  return joints;
}

Json marker_json(const Body& body, const reconstruct::SolvedMarkers& solved) {
  Json markers = Json::array();
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    const reconstruct::MarkerFit& fit = solved.markers[m];
    if (fit.frames == 0) continue;
    markers.push_back({{"marker", body.markers[m].label},
                       {"rms_mm", mm(fit.rms_m)},
                       {"worst_mm", mm(fit.worst_m)},
                       {"frames", fit.frames}});
  }
  return markers;
}

Json trial_json(const Body& body, const MarkerTrial& trial) {
  Json out{{"trial", trial.name}, {"prefix", trial.prefix}};
  out.update(repair_json(trial.repair));
  out["samples_predicted"] = trial.samples_predicted;
  out["samples_left_empty"] = trial.samples_empty;
  out["frames_with_markers"] = frames_with_markers(trial);
  out["frames_solved"] = trial.solved ? trial.solved->frames_solved : 0;
  out["rms_mm"] = trial.solved ? Json(mm(trial.solved->rms_m)) : Json();
  out["by_marker"] = trial.solved ? marker_json(body, *trial.solved) : Json::array();
  out["avatars"] = trial.avatars;
  return out;
}

}  // namespace

std::string why_unused(const FitLabels& labels, std::size_t label) {
  const auto& ignored = labels.names.is_ignored;
  if (!ignored.empty() && ignored[label]) return "is to be ignored";
  if (labels.names.is_computed[label]) return "is a computed point or a device";
  if (labels.samples[label] == 0) return "is never seen";
  if (labels.names.landmarks[label] == nullptr) {
    return "is not known, and moves with no segment or is seen too rarely";
  }
  return "moves with no segment, or is seen too rarely";
}

Json fit_json(const FitRun& run) {
  Json labels = Json::array();
  for (std::size_t i = 0; i < run.labels.labels.size(); ++i) {
    labels.push_back(label_json(run, i));
  }
  Json trials = Json::array();
  for (const MarkerTrial& trial : run.trials) {
    trials.push_back(trial_json(run.body, trial));
  }
  Json out{{"format", 1},
           {"subject", run.body.name},
           {"stature_m", rounded(run.body.stature_m, 4)},
           {"label_set", run.labels.names.set}};
  if (run.subject) {
    const LabelledFit& subject = *run.subject;
    const auto& measured = subject.fit.measured_stature;
    out["measured_stature_m"] = measured ? Json(rounded(measured->stature_m, 4)) : Json();
    out["stature_sigma_m"] = measured ? Json(rounded(measured->sigma_m, 4)) : Json();
    out["stature_pairs"] = subject.fit.stature_pairs;
    out["fit_rms_mm"] = mm(subject.fit.rms_m);
    out["places_off"] = rounded(subject.places_off, 3);
    out["mirrored_places_off"] = subject.mirrored_places_off
                                     ? Json(rounded(*subject.mirrored_places_off, 3))
                                     : Json();
  }
  out["labels"] = std::move(labels);
  out["label_findings"] = finding_json(run);
  out["joints"] = run.subject ? joint_json(run) : Json::array();
  out["trials"] = std::move(trials);
  out["warnings"] = messages(run.findings, Severity::kFair);
  const FitTimes& t = run.times;
  out["seconds"] = {{"read", rounded(t.read_s, 3)},
                    {"repair", rounded(t.repair_s, 3)},
                    {"fit", rounded(t.fit_s, 3)},
                    {"solve", rounded(t.solve_s, 3)},
                    {"write", rounded(t.write_s, 3)}};
  return out;
}

}  // namespace marey::app
