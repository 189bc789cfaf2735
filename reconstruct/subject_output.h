// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the result of a subject's fit, from its refined bundle.

#include <span>

#include "reconstruct/fit_subject.h"
#include "reconstruct/refine_subject.h"

namespace marey::reconstruct {

/// Returns the median ratio of measured limb segments to an average person's.
[[nodiscard]] double limb_ratio(const Lengths& measured,
                                const Lengths& usual,
                                std::span<const Length> segments);

/// Returns the bundle as a body with its sigmas, and what was left out of it. Its doubts
/// are empty. Preconditions: fill_sigmas(); the bundle has frames of standing.
[[nodiscard]] SubjectFit to_fit(const SubjectPrior& prior,
                                const SubjectBundle& bundle,
                                const SubjectEvidence& evidence,
                                const Proportions& average);

}  // namespace marey::reconstruct
