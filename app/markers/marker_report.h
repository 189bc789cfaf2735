// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "app/markers/fit_json.h"
#include "app/markers/repair_json.h"

namespace marey::app {

// The pages of labelled markers. Each is one self-contained file. Same input, same bytes.
// docs/formats/README.md describes the JSON inside.

/// Returns fit.html: labels, samples and joints of every trial, before and after. Linear
/// in samples; at most a few hundred kilobytes per trial, whatever its length.
[[nodiscard]] std::string fit_page(const FitRun& run);

/// Returns OUT.repair.html: the same for one file that was only repaired. `notes` are the
/// reader's.
[[nodiscard]] std::string repair_page(const Repair& repair,
                                      std::span<const std::string> notes);

}  // namespace marey::app
