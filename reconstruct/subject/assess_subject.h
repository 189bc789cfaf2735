// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: checks of a fitted subject.

#include <vector>

#include "core/base/result.h"
#include "core/finding.h"
#include "reconstruct/subject/refine_subject.h"

namespace marey::reconstruct {

/// Removes the tags of a hand or foot from the model if their place is uncertain: no
/// place or two places explain their sightings, or two cameras hardly ever see them or
/// the bone before them. Writes the reasons to `evidence.left_out` (poor). Returns
/// whether a tag was removed.
bool leave_out_extremities(SubjectBundle& bundle, SubjectEvidence& evidence);

/// Assesses the fitted subject by signs of errors: tags whose sightings it does not
/// explain, hands and feet that were left out, limbs that hardly any frame locates, tags
/// fitted to places without skin of their segment, thighs or upper arms turned by more
/// than 100 degrees while standing, left and right sides that differ, lengths far from a
/// person's of the stature, and hips, knees, shoulders and elbows with large sigmas. Each
/// is poor; empty if there is no sign of an error.
[[nodiscard]] std::vector<Finding> assess_subject(const SubjectBundle& bundle,
                                                  const SubjectEvidence& evidence);

}  // namespace marey::reconstruct
