// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/result.h"
#include "reconstruct/trial_residuals.h"
#include "recordings/session.h"

namespace marey::app {

/// Judges what a solved trial leaves unexplained, at the body: errors of a camera that
/// follow the movement (its clock), and the worst camera, tag and half second. Slips of
/// tags on soft skin pass. Each is kQuality, with what to check; empty when all is well.
[[nodiscard]] std::vector<Error> judge_trial(
    const recordings::Session& session,
    const recordings::Trial& trial,
    const reconstruct::TrialResiduals& residuals);

}  // namespace marey::app
