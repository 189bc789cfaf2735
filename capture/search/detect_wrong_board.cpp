// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/detect_wrong_board.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "capture/boards/find_board_points.h"
#include "capture/search/sample_frames.h"
#include "capture/search/survey_frames.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

/// Returns the number of frames per recording: a dozen for two recordings, fewer for more
/// cameras, as all see the same board.
int frames_of_each(std::size_t inputs) {
  return std::max(6, 24 / static_cast<int>(inputs));
}

Result<BoardFinder> finder_of(const CalibrationTarget& target) {
  if (const auto* charuco = std::get_if<CharucoBoard>(&target)) {
    return BoardFinder::create(*charuco);
  }
  MAREY_ASSERT(std::holds_alternative<Chessboard>(target));
  return BoardFinder::create(std::get<Chessboard>(target));
}

/// The frames of one recording, up to the first with the target.
struct InputSample {
  std::vector<cv::Mat> frames;
  bool shows_target = false;
};

InputSample sample_input(const CameraInput& input,
                         int count,
                         const CalibrationTarget& target,
                         const std::atomic<bool>& enough) {
  InputSample sample;
  auto finder = finder_of(target);
  if (!finder) {
    sample.shows_target = true;  // The full search will report the error.
    return sample;
  }
  sample_frames(input.path, input.range, count, [&](const GrayFrame& frame) {
    sample.frames.push_back(matrix_of(frame).clone());
    sample.shows_target = !finder->find(frame).empty();
    return !sample.shows_target && !enough;
  });
  return sample;
}

/// Returns all recordings' samples; nullopt as soon as one shows the target.
std::optional<std::vector<InputSample>> sample_inputs(std::span<const CameraInput> inputs,
                                                      const CalibrationTarget& target) {
  std::vector<InputSample> samples(inputs.size());
  std::atomic<std::size_t> next{0};
  std::atomic<bool> is_seen{false};
  const auto work = [&] {
    for (std::size_t i = next++; i < inputs.size() && !is_seen; i = next++) {
      samples[i] =
          sample_input(inputs[i], frames_of_each(inputs.size()), target, is_seen);
      if (samples[i].shows_target) is_seen = true;
    }
  };
  {
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < std::min(cores, inputs.size()); ++i) {
      threads.emplace_back(work);
    }
    work();
  }
  if (is_seen) return std::nullopt;
  return samples;
}

}  // namespace

std::optional<OtherBoard> detect_wrong_board(std::span<const CameraInput> inputs,
                                             const CalibrationTarget& target,
                                             std::span<const TagFamilyUse> worn) {
  MAREY_ASSERT(has_points(target));
  const auto samples = sample_inputs(inputs, target);
  if (!samples) return std::nullopt;
  for (std::size_t i = 0; i < samples->size(); ++i) {
    const std::vector<cv::Mat>& all = (*samples)[i].frames;
    // A subset is sufficient; every dictionary is tested on each frame.
    constexpr std::size_t kMax = 6;
    std::vector<cv::Mat> some;
    const std::size_t step = (all.size() + kMax - 1) / kMax;
    for (std::size_t f = 0; f < all.size(); f += step) some.push_back(all[f]);
    if (auto seen = survey_frames(some, target, worn)) {
      return OtherBoard{i, static_cast<int>(all.size()), std::move(*seen)};
    }
  }
  return std::nullopt;
}

}  // namespace marey::capture
