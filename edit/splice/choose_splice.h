// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/find_splice.h"
#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Returns the pair of frames at which a splice joins: the given ones, else the best of
/// find_splices() in the windows that apply_splice() documents, away from the ends by
/// half an overlap if the motions are long enough. Other good pairs are named in a
/// finding.
/// `original` is the source as it was read, in whose frames `enter_at` is given; `second`
/// is the same at the first motion's rate and on its body.
/// Errors (bad input): those of apply_splice() about frames.
[[nodiscard]] Result<SpliceCandidate> choose_splice(const SpliceOp& op,
                                                    const EditOp& common,
                                                    const EditState& first,
                                                    const EditState& original,
                                                    const EditState& second,
                                                    OpReport& report);

}  // namespace marey::edit
