// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: reasons not to trust a fitted subject.

#include <vector>

#include "core/result.h"
#include "reconstruct/refine_subject.h"

namespace marey::reconstruct {

/// Takes the tags of a hand or foot out of the model where they have no certain place:
/// where no place or two places explain their sightings, or two cameras hardly ever see
/// them or the bone before them. Writes the reasons to `evidence.left_out` (kQuality).
/// Returns whether a tag was taken out.
bool leave_out_extremities(SubjectBundle& bundle, SubjectEvidence& evidence);

/// Compares the fitted subject with what it would look like if it were wrong: tags whose
/// sightings it does not explain, hands and feet that were left out, limbs that hardly
/// any frame locates, tags fitted where their segment has no skin, thighs or upper arms
/// turned by more than 100 degrees while standing, left and right sides that differ,
/// lengths far from a person's of the stature, hips, knees, shoulders and elbows that are
/// hardly known. Each is kQuality; empty when nothing speaks against the fit.
[[nodiscard]] std::vector<Error> doubts_of(const SubjectBundle& bundle,
                                           const SubjectEvidence& evidence);

}  // namespace marey::reconstruct
