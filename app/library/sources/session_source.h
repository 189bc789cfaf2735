// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/library/sources/source_motion.h"
#include "core/base/result.h"

namespace marey::app {

/// Solves the motions of a session's folder as `marey process` does: one for each motion
/// trial, with its uncertainty; SourceMotion::body is the trial's name. Results of the
/// stages go to a temporary folder in `scratch` (empty: the system's), which is removed.
///
/// Figures: residual_px (root mean square distance of tag corners), solved_share (share
/// of the frames that are solved). Findings of the run are remarks; those of one trial
/// are remarks of its motion.
/// Errors: Pipeline's; no temporary folder. The result does not depend on the number of
/// cores.
[[nodiscard]] Result<std::vector<SourceMotion>> read_session_source(
    const std::filesystem::path& folder, const std::filesystem::path& scratch);

}  // namespace marey::app
