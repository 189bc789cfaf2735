// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/label_checks.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

using reconstruct::FaultyLabel;
using reconstruct::LabelFault;

// Markers are placed again between trials, and skin moves: below this limit the effect on
// the joints is a few millimetres. [m]
constexpr double kFarElsewhere_m = 0.040;
// Number of labels that a fit may leave out: a single one has little effect.
constexpr std::size_t kMaxLeftOut = 1;
// Minimum number of samples for which a label's place can be found.
constexpr std::size_t kMinSamples = 3;
constexpr std::size_t kMaxShownLabels = 4;

std::string in_mm(double length_m) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.0f mm", 1e3 * length_m);
  return text.data();
}

std::string listed_labels(std::span<const std::string> labels) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kMaxShownLabels, labels.size()); ++i) {
    text += (i > 0 ? ", " : "") + in_quotes(labels[i]);
  }
  if (labels.size() <= kMaxShownLabels) return text;
  return text + " and " + std::to_string(labels.size() - kMaxShownLabels) + " more";
}

std::string all_trials(std::span<const MarkerTrial> trials) {
  return trials.size() == 1 ? trials[0].path.string() : "";
}

Finding exchanged_in_trial(const FaultyLabel& finding,
                           std::span<const MarkerTrial> trials) {
  const MarkerTrial& trial = trials[*finding.trial];
  std::string cause = "markers " + in_quotes(finding.label) + " and " +
                      in_quotes(finding.other) + " look exchanged: they are " +
                      in_mm(finding.off_m) + " from their places in the other trials, " +
                      in_mm(finding.exchanged_m) + " when exchanged";
  std::string next = "exchange the two labels in this file";
  if (finding.or_trial) {
    cause = "markers " + in_quotes(finding.label) + " and " + in_quotes(finding.other) +
            " look exchanged here or in " + trials[*finding.or_trial].path.string() +
            ": " + in_mm(finding.off_m) + " apart, " + in_mm(finding.exchanged_m) +
            " when exchanged";
    next = "exchange the two labels in the file that is wrong";
  }
  return {Severity::kPoor, "exchanged", trial.path.string(), cause, next};
}

Finding exchanged_in_all(const reconstruct::LabelExchange& exchange,
                         std::span<const MarkerTrial> trials) {
  if (!exchange.limbs.empty()) {
    return {Severity::kPoor,
            "exchanged",
            all_trials(trials),
            "left and right of " + exchange.limbs +
                " seem exchanged: the body explains the markers far better so",
            "exchange left and right in the labels of " + exchange.limbs +
                ", in the recording or with --markers MAP.toml"};
  }
  const auto& [a, b] = exchange.labels.front();
  return {Severity::kPoor,
          "exchanged",
          all_trials(trials),
          "markers " + in_quotes(a) + " and " + in_quotes(b) +
              " look exchanged in all trials: the body explains the markers far "
              "better so",
          "exchange the two labels, in the recording or with --markers MAP.toml"};
}

/// Returns the labels of all findings of one kind, for one message.
std::vector<std::string> labels_with(std::span<const FaultyLabel> findings,
                                     LabelFault fault) {
  std::vector<std::string> labels;
  for (const FaultyLabel& finding : findings) {
    if (finding.fault == fault) labels.push_back(finding.label);
  }
  return labels;
}

double farthest_m(std::span<const FaultyLabel> findings, LabelFault fault) {
  double off_m = 0.0;
  for (const FaultyLabel& finding : findings) {
    if (finding.fault == fault) off_m = std::max(off_m, finding.off_m);
  }
  return off_m;
}

void assess_places(const LabelChecks& checks,
                   std::span<const MarkerTrial> trials,
                   std::vector<Finding>& poor) {
  const std::string next =
      "check the meaning of these labels, and whether labels are exchanged (--markers "
      "MAP.toml)";
  const auto off = labels_with(checks.of_fit, LabelFault::kOffLandmark);
  if (!off.empty()) {
    poor.push_back(
        {Severity::kPoor,
         "landmark",
         all_trials(trials),
         "markers are too far from their landmark for any body: " + listed_labels(off) +
             ", up to " + in_mm(farthest_m(checks.of_fit, LabelFault::kOffLandmark)),
         next});
  }
  const auto moved = labels_with(checks.of_fit, LabelFault::kMoved);
  if (!moved.empty()) {
    poor.push_back({Severity::kPoor,
                    "moved",
                    all_trials(trials),
                    "markers move with segments far from those they are named for: " +
                        listed_labels(moved),
                    "see whether labels, or left and right, are exchanged "
                    "(--markers MAP.toml)"});
  }
  const auto left_out = labels_with(checks.of_fit, LabelFault::kLeftOut);
  if (left_out.size() > kMaxLeftOut) {
    poor.push_back(
        {Severity::kPoor,
         "left-out",
         all_trials(trials),
         "markers move with no segment of the body: " + listed_labels(left_out),
         "see whether all trials are of one person with the markers where "
         "they were, and whether labels are exchanged"});
  }
}

}  // namespace

LabelChecks find_label_faults(const Body& body,
                              const reconstruct::MarkerSubject& given,
                              const LabelledFit* subject,
                              const FitLabels& labels,
                              std::span<const MarkerTrial> trials) {
  const std::vector<reconstruct::NamedMarker> markers = used_labels(labels);
  std::vector<reconstruct::CheckedTrial> checked;
  for (const MarkerTrial& trial : trials) {
    checked.push_back(
        {&trial.repair.repaired.tracks, trial.solved ? &*trial.solved : nullptr});
  }
  LabelChecks checks;
  checks.of_trials = reconstruct::assess_trial_labels(body, markers, checked);
  if (subject == nullptr) return checks;
  checks.of_fit = reconstruct::assess_fit_labels(subject->fit, markers);
  // Labels with few samples are left out for that reason, not for their motion.
  const std::size_t max_samples =
      *std::max_element(labels.samples.begin(), labels.samples.end());
  const std::size_t needed = std::max<std::size_t>(kMinSamples, max_samples / 20);
  std::erase_if(checks.of_fit, [&](const FaultyLabel& finding) {
    const auto at = std::find(labels.labels.begin(), labels.labels.end(), finding.label);
    return at != labels.labels.end() &&
           labels.samples[static_cast<std::size_t>(at - labels.labels.begin())] < needed;
  });
  const bool is_explained = std::any_of(
      checks.of_trials.begin(), checks.of_trials.end(), [](const FaultyLabel& finding) {
        return finding.fault == LabelFault::kExchanged;
      });
  if (is_explained || subject->mirrored_places_off) return checks;
  std::vector<MarkerTracks> tracks;
  for (const MarkerTrial& trial : trials) tracks.push_back(trial.repair.repaired.tracks);
  checks.exchange = reconstruct::find_exchange(given, tracks, markers, subject->fit);
  return checks;
}

std::vector<Finding> assess_labels(const LabelChecks& checks,
                                   std::span<const MarkerTrial> trials) {
  std::vector<Finding> poor;
  for (const FaultyLabel& finding : checks.of_trials) {
    if (finding.fault == LabelFault::kExchanged) {
      poor.push_back(exchanged_in_trial(finding, trials));
    }
  }
  if (checks.exchange) poor.push_back(exchanged_in_all(*checks.exchange, trials));
  // An exchange is the cause of other findings and is returned alone.
  if (!poor.empty()) return poor;
  assess_places(checks, trials, poor);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    std::vector<std::string> labels;
    double off_m = 0.0;
    for (const FaultyLabel& finding : checks.of_trials) {
      if (finding.trial != t || finding.off_m < kFarElsewhere_m) continue;
      labels.push_back(finding.label);
      off_m = std::max(off_m, finding.off_m);
    }
    if (labels.empty()) continue;
    poor.push_back({Severity::kPoor,
                    "places",
                    trials[t].path.string(),
                    "markers are not at their places on the body: " +
                        listed_labels(labels) + ", up to " + in_mm(off_m) + " off",
                    "see whether these labels are wrong in this trial, whether markers "
                    "fell off, and whether all trials are of one person"});
  }
  return poor;
}

}  // namespace marey::app
