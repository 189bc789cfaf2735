// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "benchmarks/adapt_cases.h"
#include "benchmarks/result_table.h"

namespace marey {

/// How long and how near a posture takes, by class of cases, with and without balance.
[[nodiscard]] std::vector<ResultTable> measure_classes(const CaseSet& cases);

}  // namespace marey
