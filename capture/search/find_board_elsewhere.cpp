// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/find_board_elsewhere.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include <opencv2/core.hpp>

#include "capture/boards/find_board_points.h"
#include "capture/search/sample_frames.h"
#include "capture/tags/detect_tags.h"
#include "core/base/assert.h"
#include "core/base/frame_range.h"

namespace marey::capture {
namespace {

// Fewer tags than this in an image may be false detections.
constexpr std::ptrdiff_t kMinTags = 4;

GrayFrame view_of(const cv::Mat& picture) {
  return {picture.data, picture.cols, picture.rows, static_cast<int>(picture.step[0]), 0};
}

/// Returns true if an image shows a board.
using Finder = std::function<bool(const GrayFrame&)>;

Finder grid_finder(const AprilGrid& grid, const std::string& family) {
  TagDetectorOptions options;
  options.families = {{family, {}}};
  options.align_patterns = false;
  auto made = TagDetector::create(options);
  if (!made) return [](const GrayFrame&) { return false; };
  auto detector = std::make_shared<TagDetector>(std::move(*made));
  return [detector, grid](const GrayFrame& frame) {
    const auto tags = detector->detect(frame);
    return std::count_if(tags.begin(), tags.end(), [&](const TagDetection& tag) {
             return grid.contains(tag.id);
           }) >= kMinTags;
  };
}

template <class Board>
Finder point_finder(const Board& board) {
  auto made = BoardFinder::create(board);
  if (!made) return [](const GrayFrame&) { return false; };
  auto finder = std::make_shared<BoardFinder>(std::move(*made));
  return [finder](const GrayFrame& frame) { return !finder->find(frame).empty(); };
}

Finder finder_of(const CalibrationTarget& target, const std::string& family) {
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    return grid_finder(*grid, family);
  }
  if (const auto* charuco = std::get_if<CharucoBoard>(&target)) {
    return point_finder(*charuco);
  }
  MAREY_ASSERT(std::holds_alternative<Chessboard>(target));
  return point_finder(std::get<Chessboard>(target));
}

std::ptrdiff_t count(const std::vector<cv::Mat>& frames, const Finder& shows) {
  return std::count_if(frames.begin(), frames.end(), [&](const cv::Mat& picture) {
    return shows(view_of(picture));
  });
}

/// Searches for the grid's tags seen from behind, or for tags of another family.
std::optional<AlternativeTarget> find_other_grid(const std::vector<cv::Mat>& frames,
                                                 const AprilGrid& grid,
                                                 const std::string& family) {
  std::vector<cv::Mat> mirrored;
  for (const cv::Mat& picture : frames) {
    cv::flip(picture, mirrored.emplace_back(), /*flipCode=*/1);
  }
  const std::string all = std::to_string(frames.size());
  if (const auto shown = count(mirrored, grid_finder(grid, family)); shown > 0) {
    return AlternativeTarget{
        AlternativeKind::kAprilGrid,
        family,
        true,
        "the mirror image of " + std::to_string(shown) + " of " + all +
            " frames shows its tags: the video is mirrored",
        "switch off mirroring in the camera's software and record again, or flip the "
        "video back; if the print itself is mirrored, print it again"};
  }
  for (const std::string other :
       {"tag36h11", "tag36h11b2", "tag25h9", "tag36h10", "tag16h5"}) {
    if (other == family) continue;
    // Families of few bits have false detections in noise.
    const auto shown = count(frames, grid_finder(grid, other));
    if (shown < (other == "tag16h5" ? 3 : 1)) continue;
    return AlternativeTarget{
        AlternativeKind::kAprilGrid,
        other,
        false,
        "tags of family " + other + " are in " + std::to_string(shown) + " of " + all +
            " frames, and [board] names the family " + family,
        "write family = \"" + other + "\" in [board] of session.toml"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<AlternativeTarget> find_board_elsewhere(
    const std::filesystem::path& path,
    const CalibrationTarget& target,
    const std::string& family,
    const std::optional<FrameRange>& searched) {
  constexpr int kFrames = 24;
  std::vector<cv::Mat> frames;
  sample_frames(path, std::nullopt, kFrames, [&](const GrayFrame& frame) {
    frames.push_back(matrix_of(frame).clone());
    return true;
  });
  if (searched) {
    const auto shown = count(frames, finder_of(target, family));
    if (shown > 0) {
      return AlternativeTarget{
          AlternativeKind::kExpected,
          "",
          false,
          "the board is in " + std::to_string(shown) + " of " +
              std::to_string(frames.size()) + " frames from all over the video",
          "widen `frames` of the trial in session.toml, or leave it out"};
    }
  }
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    return find_other_grid(frames, *grid, family);
  }
  return std::nullopt;
}

}  // namespace marey::capture
