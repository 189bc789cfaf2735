// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/finding.h"
#include "reconstruct/tags/trial_residuals.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Tests the residuals of a solved trial, in metres at the body, in this order: camera
/// errors that follow the movement (clock errors), the worst camera, the worst tag, the
/// worst half second. Each has an absolute limit and a limit relative to the median of
/// the others. Slips of tags on soft skin pass. Returns the first test that fails, since
/// later ones are mostly its consequence: poor, with the next step. nullopt if all
/// tests pass.
[[nodiscard]] std::optional<Finding> assess_trial(
    const recordings::Session& session,
    const recordings::Trial& trial,
    const reconstruct::TrialResiduals& residuals);

}  // namespace marey::app
