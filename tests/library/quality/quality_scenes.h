// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "library/quality/measure_quality.h"

#include "core/library/library_motion.h"

namespace marey::library {

/// Returns an average adult of this stature in the T-pose, all parts of the feet bearing.
[[nodiscard]] LibraryMotion standing_clip(int frames, double hz, double stature_m = 1.63);

/// Returns a walk with swinging arms.
[[nodiscard]] LibraryMotion walking_clip(int frames, double hz);

/// Returns an average adult in the T-pose that stands, and flies twice for 0.4 s under
/// gravity.
[[nodiscard]] LibraryMotion jumping_clip(double hz);

/// Measures a clip with the default limits.
[[nodiscard]] QualityResult measured(const LibraryMotion& clip);

/// Returns a figure by its name. Precondition: it exists.
[[nodiscard]] const ClipFigure& figure(const QualityResult& result,
                                       std::string_view name);

}  // namespace marey::library
