// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: reasons not to trust a fitted subject.

#include <vector>

#include "core/result.h"
#include "reconstruct/refine_subject.h"

namespace marey::reconstruct {

/// Compares the fitted subject with what it would look like if it were wrong: tags whose
/// sightings it does not explain, a second place of a hand's or foot's tags that explains
/// them as well, limbs that two cameras hardly ever see or that hardly any frame locates,
/// tags fitted where their segment has no skin, thighs or upper arms turned by more than
/// 100 degrees while standing, left and right sides that differ, lengths far from a
/// person's of the stature, hips, knees, shoulders and elbows that are hardly known. Each
/// is kQuality; empty when nothing speaks against the fit.
[[nodiscard]] std::vector<Error> doubts_of(const SubjectBundle& bundle,
                                           const SubjectEvidence& evidence);

}  // namespace marey::reconstruct
