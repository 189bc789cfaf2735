// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/markers/fit_json.h"
#include "core/finding.h"

namespace marey::app {

// Messages of `marey fit`: sentences without a full stop. Each line stands alone.

/// Returns lines on the set of labels, the unused labels with reasons, the subject's
/// size, and the joint centres that are an average body's.
[[nodiscard]] std::vector<std::string> subject_words(const FitRun& run);

/// Returns fair findings: notes on names, markers that move with another segment than
/// that of their name, wrong samples, bodies that hang head down.
[[nodiscard]] std::vector<Finding> assess_run(const FitRun& run);

/// Returns "walk: RMS 8.1 mm, 100 % of 250 frames solved, 12 samples filled".
[[nodiscard]] std::string trial_words(const MarkerTrial& trial);

}  // namespace marey::app
