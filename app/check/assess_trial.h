// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/result.h"
#include "reconstruct/tags/trial_residuals.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Judges what a solved trial leaves unexplained, in metres at the body: errors of a
/// camera that follow the movement (its clock), the worst camera, the worst tag, the
/// worst half second, each against a limit and against the others' median. Slips of tags
/// on soft skin pass. Returns the first of these in this order that fails, as later ones
/// are mostly its consequence: kQuality, with what to check. nullopt when all is well.
[[nodiscard]] std::optional<Error> assess_trial(
    const recordings::Session& session,
    const recordings::Trial& trial,
    const reconstruct::TrialResiduals& residuals);

}  // namespace marey::app
