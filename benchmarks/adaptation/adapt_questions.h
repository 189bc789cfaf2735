// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "benchmarks/adaptation/adapt_cases.h"
#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"

namespace marey {

/// Measures time and error of a posture by class of cases, with and without balance.
[[nodiscard]] std::vector<ResultTable> measure_classes(const CaseSet& cases);

/// Measures the number of different bodies that a core moves.
[[nodiscard]] std::vector<ResultTable> measure_crowd(const CaseSet& cases);

/// Measures if a person with joint limits reaches the targets of its other postures.
[[nodiscard]] std::vector<ResultTable> measure_reach();

/// Measures the thesis' tables 4.1 to 4.3, 5.2 and 5.3, with its printed values.
[[nodiscard]] std::vector<ResultTable> measure_thesis();

/// Measures the difference of adapted postures from captured ones of the same action.
[[nodiscard]] std::vector<ResultTable> measure_captured(
    const std::vector<CapturedClip>& clips);

}  // namespace marey
