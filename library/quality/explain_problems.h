// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "library/quality/quality_limits.h"

#include "core/library/clip_record.h"

namespace marey::library {

/// Removes the problems that follow from another one, the strongest cause first: a
/// problem of the whole clip (scale, sides, rate, jitter...) explains the kinds that it
/// causes everywhere; a local one (swap, flip, cut, frozen, spike) those within three
/// frames. Quadratic in problems per kind, which are few.
void remove_explained(std::vector<ClipProblem>& problems);

/// Returns the kind of the first rule that has a problem; empty: there are none.
[[nodiscard]] std::string main_kind(std::span<const ClipProblem> problems,
                                    std::span<const FigureRule> rules);

}  // namespace marey::library
