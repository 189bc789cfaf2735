// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/find/find_splice.h"
#include "edit/state/edit_state.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Returns the pairs of frames at which a splice may join, best match first: the given
/// ones, else the best of find_splices() in the windows that apply_splice() documents,
/// away from the ends by half of `overlap_s` if the motions are long enough. Not empty.
/// `original` is the source as it was read, in whose frames `enter_at` is given; `second`
/// is the same at the first motion's rate and on its body.
/// Errors (bad input): those of apply_splice() about frames.
[[nodiscard]] Result<std::vector<SpliceCandidate>> choose_splice(
    const SpliceOp& op,
    const EditOp& common,
    const EditState& first,
    const EditState& original,
    const EditState& second,
    double overlap_s);

}  // namespace marey::edit
