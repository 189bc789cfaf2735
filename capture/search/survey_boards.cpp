// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/survey_boards.h"

#include <vector>

#include <opencv2/core.hpp>

#include "capture/search/sample_frames.h"
#include "capture/search/survey_frames.h"

namespace marey::capture {

std::optional<AlternativeTarget> survey_boards(const std::filesystem::path& path,
                                               const CalibrationTarget& target,
                                               std::span<const TagFamilyUse> worn) {
  constexpr int kFrames = 8;
  std::vector<cv::Mat> frames;
  sample_frames(path, std::nullopt, kFrames, [&](const GrayFrame& frame) {
    frames.push_back(matrix_of(frame).clone());
    return true;
  });
  return survey_frames(frames, target, worn);
}

}  // namespace marey::capture
