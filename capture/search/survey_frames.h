// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "capture/search/alternative_target.h"
#include "core/board.h"
#include "core/tag_family.h"

// Private to capture.
namespace marey::capture {

/// Searches single frames in the same way as survey_boards().
[[nodiscard]] std::optional<AlternativeTarget> survey_frames(
    const std::vector<cv::Mat>& frames,
    const CalibrationTarget& target,
    std::span<const TagFamilyUse> worn);

}  // namespace marey::capture
