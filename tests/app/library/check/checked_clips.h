// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/library/clip_record.h"

namespace marey::testing {

/// Returns clips with all figures of the gate: some 90 % pass, the others have a spike, a
/// slide, an exchange or jitter, with problems. Same count, same clips.
[[nodiscard]] std::vector<ClipRecord> checked_clips(int count);

}  // namespace marey::testing
