// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Forms of findings for users and programs: lines of the console, exit code, JSON.

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/shell/console.h"
#include "app/shell/exit_codes.h"
#include "core/finding.h"

namespace marey::app {

/// Prints the findings that are kFair as warnings.
void print_warnings(Console& console, std::span<const Finding> findings);

/// Prints the findings that are kPoor as errors. Returns the exit code of the last one;
/// kOk if there is none.
Exit print_failures(Console& console, std::span<const Finding> findings);

/// Returns one line per finding that is at least as severe.
[[nodiscard]] std::vector<std::string> messages(std::span<const Finding> findings,
                                                Severity min_severity);

/// Returns "note", "fair" or "poor".
[[nodiscard]] const char* name(Severity severity);

/// Returns a list of objects with severity, kind, where, cause and next.
[[nodiscard]] nlohmann::ordered_json findings_json(std::span<const Finding> findings);

}  // namespace marey::app
