// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/markers/marker_state.h"

#include "core/base/result.h"

namespace marey::edit {

/// Applies one operation to labelled markers. Pure: same input, same result, to the bit.
/// keep and split give several states.
///
/// cut, keep, split, filter, place, mirror, retime, scale_time, tag, event and curve have
/// a meaning for markers. The others work on the joints of a body and are refused, with
/// the reason and the way to a body.
/// Errors (bad input), with the operation as place: a refused operation; a version that
/// this program does not have; those of the functions in this folder and in edit/ops/.
[[nodiscard]] Result<std::vector<MarkerState>> apply_marker_op(
    const MarkerOpContext& context, const MarkerState& state, OpReport& report);

}  // namespace marey::edit
