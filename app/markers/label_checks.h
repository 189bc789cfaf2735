// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/markers/fit_labels.h"
#include "app/markers/marker_trials.h"
#include "core/finding.h"
#include "reconstruct/markers/assess_labels.h"
#include "reconstruct/markers/find_exchanges.h"

namespace marey::app {

/// Findings on the labels of a fit and of its trials.
struct LabelChecks {
  std::vector<reconstruct::FaultyLabel> of_fit;
  std::vector<reconstruct::FaultyLabel> of_trials;
  std::optional<reconstruct::LabelExchange> exchange;
};

/// Checks every label of the solved trials. `subject` may be null: an earlier fit was
/// used. If single trials show no exchange and the fit is suspicious, searches for an
/// exchange in all trials, which costs up to nine small fits.
[[nodiscard]] LabelChecks find_label_faults(const Body& body,
                                            const reconstruct::MarkerSubject& given,
                                            const LabelledFit* subject,
                                            const FitLabels& labels,
                                            std::span<const MarkerTrial> trials);

/// Returns the poor findings: exchanged labels, with the correction;
/// markers at implausible distances from their landmark; markers at another place in one
/// trial; labels left out.
[[nodiscard]] std::vector<Finding> assess_labels(const LabelChecks& checks,
                                                 std::span<const MarkerTrial> trials);

}  // namespace marey::app
