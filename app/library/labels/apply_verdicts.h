// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "app/library/labels/apply_labels.h"
#include "core/library/clip_record.h"
#include "recordings/library/verdict_file.h"

namespace marey::app {

/// Replaces verdicts of a clip by those of people, in order; the last one counts. The
/// quality of the clip becomes its worst figure's again, or that of a correction of
/// kQualityFigure.
///
/// A verdict better than the measured one is applied if its frames include a frame of the
/// figure's worst place, or if either has no frames: a correction of another place, from
/// before the motion was processed differently, stays without effect. `pass` removes the
/// problems of the figure's kind, unless another figure of this kind still has a worse
/// verdict. A verdict worse than the measured one is always applied, and adds a problem
/// if it has frames, cut to the clip.
///
/// Returns the corrections that had no effect: another clip's, of a figure that the clip
/// does not have, or of another place. Values of figures never change. Pure.
[[nodiscard]] std::vector<recordings::VerdictCorrection> apply_verdicts(
    ClipRecord& record, std::span<const recordings::VerdictCorrection> corrections);

/// Applies the corrections of a library to all its clips. Returns those without effect.
/// Linear in records and corrections.
[[nodiscard]] std::vector<UnusedLabel> apply_library_verdicts(
    const LibraryLabels& labels, std::vector<ClipRecord>& records);

}  // namespace marey::app
