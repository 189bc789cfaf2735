// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/finding_list.h"

namespace marey::app {

/// Judges second hypotheses: a camera that was moved during the recording, a rolling
/// shutter that was not solved for.
void judge_faults(FindingList& list);

/// Whether judge_faults() names this camera as moved.
[[nodiscard]] bool seems_moved(const CalibrationReport& report, std::size_t c);

}  // namespace marey::app
