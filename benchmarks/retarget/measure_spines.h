// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "benchmarks/parts/captured_clips.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/result.h"

namespace marey {

/// Each clip on its own body with other bones between hips and neck: one to six, the
/// first where the body's own is, the others evenly along the way to the neck, collar
/// bones on the last, all other joints at rest where they are. Reports the distances of
/// neck, shoulders and wrists from the source's, and the distance that the neck of one
/// bone has because of that bone's length.
[[nodiscard]] Result<ResultTable> measure_spines(std::span<const CapturedClip> clips);

}  // namespace marey
