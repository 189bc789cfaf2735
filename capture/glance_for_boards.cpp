// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "capture/find_board_points.h"
#include "capture/look_for_boards.h"
#include "capture/sample_frames.h"
#include "core/assert.h"

namespace marey::capture {
namespace {

/// Of each recording: a dozen of a pair's, fewer of more cameras, which see the same
/// board.
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

/// The frames of one recording, until one shows the target.
struct Glance {
  std::vector<cv::Mat> frames;
  bool shows_target = false;
};

Glance glance_at(const CameraInput& input,
                 int count,
                 const CalibrationTarget& target,
                 const std::atomic<bool>& enough) {
  Glance glance;
  auto finder = finder_of(target);
  if (!finder) {
    glance.shows_target = true;  // The search itself will say what is wrong.
    return glance;
  }
  sample_frames(input.path, input.range, count, [&](const GrayFrame& frame) {
    glance.frames.push_back(matrix_of(frame).clone());
    glance.shows_target = !finder->find(frame).empty();
    return !glance.shows_target && !enough;
  });
  return glance;
}

/// All recordings' glances; nullopt as soon as one shows the target.
std::optional<std::vector<Glance>> glance_at_all(std::span<const CameraInput> inputs,
                                                 const CalibrationTarget& target) {
  std::vector<Glance> glances(inputs.size());
  std::atomic<std::size_t> next{0};
  std::atomic<bool> is_seen{false};
  const auto work = [&] {
    for (std::size_t i = next++; i < inputs.size() && !is_seen; i = next++) {
      glances[i] = glance_at(inputs[i], frames_of_each(inputs.size()), target, is_seen);
      if (glances[i].shows_target) is_seen = true;
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
  return glances;
}

}  // namespace

std::optional<OtherBoard> glance_for_other_board(std::span<const CameraInput> inputs,
                                                 const CalibrationTarget& target,
                                                 std::span<const TagFamilyUse> worn) {
  MAREY_ASSERT(has_points(target));
  const auto glances = glance_at_all(inputs, target);
  if (!glances) return std::nullopt;
  for (std::size_t i = 0; i < glances->size(); ++i) {
    const std::vector<cv::Mat>& all = (*glances)[i].frames;
    // Some will do: every dictionary is tried on each.
    constexpr std::size_t kMost = 6;
    std::vector<cv::Mat> some;
    const std::size_t step = (all.size() + kMost - 1) / kMost;
    for (std::size_t f = 0; f < all.size(); f += step) some.push_back(all[f]);
    if (auto seen = look_at_frames(some, target, worn)) {
      return OtherBoard{i, static_cast<int>(all.size()), std::move(*seen)};
    }
  }
  return std::nullopt;
}

}  // namespace marey::capture
