// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/markers/fit_labels.h"
#include "app/markers/label_checks.h"
#include "app/markers/marker_trials.h"
#include "core/body.h"
#include "core/finding.h"
#include "reconstruct/markers/compare_trials.h"

namespace marey::app {

/// Durations of the stages of a run. [s]
struct FitTimes {
  double read_s = 0.0;
  double repair_s = 0.0;
  double fit_s = 0.0;
  double solve_s = 0.0;
  double write_s = 0.0;
};

/// Results of `marey fit`.
struct FitRun {
  FitLabels labels;
  std::optional<LabelledFit> subject;  ///< None: an earlier fit was used.
  Body body;
  std::vector<reconstruct::TrialGeometry> geometry;  ///< One per trial.
  LabelChecks checks;
  std::vector<MarkerTrial> trials;
  std::vector<Finding> findings;  ///< Fair ones first.
  FitTimes times;
};

/// Returns the content of fit.json; docs/formats/fit.md has the keys.
[[nodiscard]] nlohmann::ordered_json fit_json(const FitRun& run);

/// Returns the reason why a label is not used: "is never seen".
[[nodiscard]] std::string why_unused(const FitLabels& labels, std::size_t label);

}  // namespace marey::app
