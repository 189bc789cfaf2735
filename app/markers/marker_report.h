// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "app/markers/fit_figures.h"
#include "app/markers/repair_figures.h"

namespace marey::app {

// The pages of labelled markers: one file each that needs nothing else. The same bytes
// for the same input. docs/formats/README.md has the JSON inside.

/// fit.html: what became of labels, samples and joints in every trial. Linear in samples;
/// some hundred kilobytes per trial at most, however long it is.
[[nodiscard]] std::string fit_page(const FitRun& run);

/// OUT.repair.html: likewise of one file that was only repaired; `notes` are the
/// reader's.
[[nodiscard]] std::string repair_page(const Repair& repair,
                                      std::span<const std::string> notes);

}  // namespace marey::app
