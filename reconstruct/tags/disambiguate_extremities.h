// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: resolves the planar ambiguity of tags on head, hands and feet
// that one camera sees.

#include <span>

#include "core/camera.h"
#include "reconstruct/tags/body_model.h"

namespace marey::reconstruct {

/// Tries both planar candidates of the tags of head, hands and feet and keeps the better
/// one: a solver that starts from the wrong one does not leave it. `before` (the posture
/// one frame earlier, or null) adds continuity. Returns the number of extremities that
/// changed.
int disambiguate_extremities(const BodyModel& model,
                             std::span<const TagSighting> sightings,
                             std::span<const Camera> cameras,
                             const Posture* before,
                             Posture& posture);

}  // namespace marey::reconstruct
