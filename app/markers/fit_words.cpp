// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>

#include "app/markers/assess_fit.h"
#include "app/markers/trial_checks.h"

namespace marey::app {
namespace {

using reconstruct::JointOrigin;
using reconstruct::LabelUse;

constexpr std::size_t kMaxShownWords = 8;

/// Returns "a, b, c and 12 more".
std::string listed(std::span<const std::string> words) {
  // A single remaining word is printed, not counted.
  const std::size_t shown =
      words.size() <= kMaxShownWords + 1 ? words.size() : kMaxShownWords;
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i > 0 ? ", " : "") + words[i];
  if (shown == words.size()) return text;
  return text + " and " + std::to_string(words.size() - shown) + " more";
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

bool is_used(const FitRun& run, const std::string& label) {
  return std::any_of(run.body.markers.begin(),
                     run.body.markers.end(),
                     [&](const auto& marker) { return marker.label == label; });
}

std::string set_words(const FitRun& run) {
  const auto& landmarks = run.labels.names.landmarks;
  const auto named = landmarks.size() - static_cast<std::size_t>(std::count(
                                            landmarks.begin(), landmarks.end(), nullptr));
  const std::string& set = run.labels.names.set;
  std::string text = set.empty() ? "labels of an unknown set" : "labels: " + set;
  return text + ", " + std::to_string(named) + " of " + std::to_string(landmarks.size()) +
         " have a known place";
}

/// Returns the unused labels, grouped by reason.
std::vector<std::string> unused_words(const FitRun& run) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (std::size_t i = 0; i < run.labels.labels.size(); ++i) {
    if (is_used(run, run.labels.labels[i])) continue;
    const std::string why = run.subject ? why_unused(run.labels, i)
                                        : std::string("is not one of the subject's");
    by_reason[why].push_back(run.labels.labels[i]);
  }
  std::vector<std::string> lines;
  for (const auto& [why, labels] : by_reason) {
    lines.push_back("not used, because it " + why + ": " + listed(labels));
  }
  return lines;
}

/// Returns the subject's stature and its uncertainty.
std::string stature_words(const LabelledFit& subject, const Body& body) {
  const auto& measured = subject.fit.measured_stature;
  if (!measured) {
    return formatted("subject: %.3f m tall (given or average: markers do not show it)",
                     body.stature_m);
  }
  if (measured->stature_m != body.stature_m) {
    return formatted("subject: %.3f m tall as given (%.2f by its markers)",
                     body.stature_m,
                     measured->stature_m);
  }
  return formatted("subject: %.3f m tall (standard deviation %.2f m)",
                   body.stature_m,
                   measured->sigma_m);
}

void add_fit_words(const LabelledFit& subject,
                   const Body& body,
                   std::vector<std::string>& lines) {
  std::vector<std::string> found;
  for (const auto& verdict : subject.fit.labels) {
    if (verdict.use != LabelUse::kFound) continue;
    found.push_back(verdict.label + " on " + std::string(name(verdict.segment)));
  }
  if (!found.empty()) lines.push_back("found by how they move: " + listed(found));
  lines.push_back(
      stature_words(subject, body) +
      formatted(", markers %.1f mm from the body (RMS)", 1e3 * subject.fit.rms_m));
  std::vector<std::string> average;
  for (const auto& joint : subject.fit.joints) {
    if (joint.origin != JointOrigin::kProportions) continue;
    average.emplace_back(name(joint.joint));
  }
  if (!average.empty()) {
    lines.push_back("joint centres as in an average body of this size: " +
                    listed(average));
  }
}

}  // namespace

std::vector<std::string> subject_words(const FitRun& run) {
  std::vector<std::string> lines;
  if (run.subject) lines.push_back(set_words(run));
  for (std::string& line : unused_words(run)) lines.push_back(std::move(line));
  if (run.subject) {
    add_fit_words(*run.subject, run.body, lines);
  } else {
    lines.push_back(formatted("subject as given: %.3f m tall, ", run.body.stature_m) +
                    std::to_string(run.body.markers.size()) + " markers");
  }
  return lines;
}

std::vector<Finding> assess_run(const FitRun& run) {
  std::vector<Finding> found;
  for (const std::string& note : run.labels.names.notes) {
    found.push_back(fair_finding("names", "", note));
  }
  if (run.subject) {
    for (const auto& verdict : run.subject->fit.labels) {
      if (verdict.use != LabelUse::kMoved) continue;
      found.push_back(fair_finding(
          "segment",
          "",
          verdict.label + " moves with " + std::string(name(verdict.segment)) +
              ", and not with the segment of its name: used as one of its markers"));
    }
  }
  for (const MarkerTrial& trial : run.trials) {
    const std::size_t faults = trial.repair.checked.findings.size();
    if (faults > 0) {
      found.push_back(fair_finding(
          "repaired",
          trial.path.string(),
          std::to_string(faults) + (faults == 1 ? " run" : " runs") +
              " of wrong samples (exchanged, ghosts, jumps) corrected or removed: "
              "fit.json lists them"));
    }
  }
  for (Finding& finding : assess_lying(run.trials, run.geometry)) {
    found.push_back(std::move(finding));
  }
  return found;
}

std::string trial_words(const MarkerTrial& trial) {
  std::string text = trial.name + ": ";
  if (!trial.solved) return text + "not solved";
  std::size_t filled = trial.samples_predicted;
  for (const auto& gap : trial.repair.repaired.gaps) {
    if (gap.method != reconstruct::RepairMethod::kLeftEmpty) filled += gap.frames;
  }
  text += formatted("RMS %.1f mm, %.0f %% of ",
                    1e3 * trial.solved->rms_m,
                    std::floor(100.0 * share_solved(trial))) +
          std::to_string(frames_with_markers(trial)) + " frames solved";
  if (filled > 0) text += ", " + std::to_string(filled) + " samples filled";
  if (trial.samples_empty > 0) {
    text += ", " + std::to_string(trial.samples_empty) + " left empty";
  }
  return text;
}

}  // namespace marey::app
