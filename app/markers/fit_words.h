// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/markers/fit_figures.h"

namespace marey::app {

// What `marey fit` tells, in sentences without a full stop. Each line stands alone.

/// The set of labels, which of them are not used and why, how large the subject is, which
/// joint centres are an average body's.
[[nodiscard]] std::vector<std::string> subject_words(const FitRun& run);

/// What should be looked at: notes of the names, markers that move with another segment
/// than they are called after, wrong samples, bodies that hang head down.
[[nodiscard]] std::vector<std::string> fit_warnings(const FitRun& run);

/// "walk: RMS 8.1 mm, 100 % of 250 frames solved, 12 samples filled".
[[nodiscard]] std::string trial_words(const MarkerTrial& trial);

}  // namespace marey::app
