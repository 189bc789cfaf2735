// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "benchmarks/adaptation/adapt_cases.h"
#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"

namespace marey {

/// How long and how near a posture takes, by class of cases, with and without balance.
[[nodiscard]] std::vector<ResultTable> measure_classes(const CaseSet& cases);

/// How many bodies a core moves, no two alike.
[[nodiscard]] std::vector<ResultTable> measure_crowd(const CaseSet& cases);

/// Whether a person with joint limits reaches what another posture of it reaches.
[[nodiscard]] std::vector<ResultTable> measure_reach();

/// The thesis' tables 4.1 to 4.3, 5.2 and 5.3, printed beside ours.
[[nodiscard]] std::vector<ResultTable> measure_thesis();

/// How far adapted postures are from captured ones that did the same.
[[nodiscard]] std::vector<ResultTable> measure_captured(
    const std::vector<CapturedClip>& clips);

}  // namespace marey
