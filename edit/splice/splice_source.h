// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/skeleton.h"

namespace marey::edit {

/// Returns true if poses of one skeleton are poses of the other: the same joints, bones
/// and rest frames, to 1e-9.
[[nodiscard]] bool is_same_body(const Skeleton& a, const Skeleton& b);

/// Returns the source with this id as a continuation of `first`: at its rate and on its
/// body. A source at another rate is resampled by splines. One on another body is
/// retargeted (retarget/motion/retarget_motion.h), with its path and the lengths of its
/// constraints scaled by the lengths of the legs; uncertainty then is that of the same
/// bones. Both are reported. Linear in frames.
/// Errors (bad input): no such source; one whose rate or body cannot be used.
[[nodiscard]] Result<EditState> fit_splice_source(const EditState& first,
                                                  const std::string& id,
                                                  const EditInputs& inputs,
                                                  OpReport& report);

}  // namespace marey::edit
