// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/look_elsewhere.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include <opencv2/core.hpp>

#include "capture/detect_tags.h"
#include "capture/find_board_points.h"
#include "capture/sample_frames.h"
#include "core/assert.h"

namespace marey::capture {
namespace {

// Fewer tags than this in a picture may be noise that looks like them.
constexpr std::ptrdiff_t kLeastTags = 4;

GrayFrame view_of(const cv::Mat& picture) {
  return {picture.data, picture.cols, picture.rows, static_cast<int>(picture.step[0]), 0};
}

/// Whether a picture shows a board.
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
           }) >= kLeastTags;
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

/// The grid's tags seen from behind, or those of another family.
std::optional<SeenInstead> look_for_other_grid(const std::vector<cv::Mat>& frames,
                                               const AprilGrid& grid,
                                               const std::string& family) {
  std::vector<cv::Mat> mirrored;
  for (const cv::Mat& picture : frames) {
    cv::flip(picture, mirrored.emplace_back(), /*flipCode=*/1);
  }
  const std::string all = std::to_string(frames.size());
  if (const auto shown = count(mirrored, grid_finder(grid, family)); shown > 0) {
    return SeenInstead{
        "the mirror image of " + std::to_string(shown) + " of " + all +
            " frames shows its tags: the video is mirrored",
        "switch off mirroring in the camera's software and record again, or flip the "
        "video back; a print that is mirrored itself must be printed anew"};
  }
  for (const std::string other :
       {"tag36h11", "tag36h11b2", "tag25h9", "tag36h10", "tag16h5"}) {
    if (other == family) continue;
    // Families of few bits are seen in noise.
    const auto shown = count(frames, grid_finder(grid, other));
    if (shown < (other == "tag16h5" ? 3 : 1)) continue;
    return SeenInstead{"tags of family " + other + " are in " + std::to_string(shown) +
                           " of " + all + " frames, and [board] tells of " + family,
                       "write family = \"" + other + "\" in [board] of session.toml"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<SeenInstead> look_elsewhere(const std::filesystem::path& path,
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
      return SeenInstead{"the board is in " + std::to_string(shown) + " of " +
                             std::to_string(frames.size()) +
                             " frames from all over the video",
                         "widen `frames` of the trial in session.toml, or leave it out"};
    }
  }
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    return look_for_other_grid(frames, *grid, family);
  }
  return std::nullopt;
}

}  // namespace marey::capture
