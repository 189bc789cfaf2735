// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the result of a subject's fit, from its refined bundle.

#include <span>

#include "reconstruct/subject/refine_subject.h"
#include "reconstruct/subject/subject_fit.h"

namespace marey::reconstruct {

/// Returns the median ratio of measured limb segments to an average person's.
[[nodiscard]] double limb_ratio(const Lengths& measured,
                                const Lengths& usual,
                                std::span<const Length> segments);

/// Converts the bundle to a body with its sigmas and the left-out parts, without
/// warnings. Preconditions: fill_sigmas(); the bundle has frames of standing.
[[nodiscard]] SubjectFit to_fit(const SubjectPrior& prior,
                                const SubjectBundle& bundle,
                                const SubjectEvidence& evidence,
                                const Proportions& average);

}  // namespace marey::reconstruct
