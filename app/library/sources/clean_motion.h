// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/library/sources/source_motion.h"
#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// Cleans a motion as library.toml states. CleanBy::kGround makes the floor level, moves
/// it to Y = 0 and makes the feet stand still during their contacts (edit operations
/// "level" and "plant"). CleanBy::kRepair changes nothing of a motion that was solved
/// from markers or tags (`is_solved`), because the solver repairs them.
///
/// Figures: cleaned_mm (largest displacement of a joint), cleaned_samples (joints of all
/// frames that moved by more than 0.1 mm). A remark states what was changed. Linear in
/// frames times joints.
/// Errors (kBadInput, `where` empty): kRepair of a motion that is not solved from
/// markers; a body without legs; no foot rests.
[[nodiscard]] Status clean_motion(CleanBy clean, bool is_solved, SourceMotion& motion);

}  // namespace marey::app
