// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "calib/model/seen_layout.h"
#include "calib/rig/check_rig.h"

namespace marey::calib {
namespace {

std::string ids_of(const AprilGrid& board) {
  return "ids " + std::to_string(board.first_id) + " to " +
         std::to_string(board.first_id + board.tag_count() - 1);
}

/// Returns "as on a board of 6 x 6 that begins with id 0", its columns first.
std::string words_of(int columns, int rows, int first_id) {
  return "a board of " + std::to_string(columns) + " x " + std::to_string(rows) +
         " that begins with id " + std::to_string(first_id);
}

/// Returns the change to `board` that makes it the board in view.
std::string declare(const SeenLayout& seen, const AprilGrid& board) {
  std::string changes;
  const auto change = [&](const char* key, int declared, int value) {
    if (declared == value) return;
    changes +=
        (changes.empty() ? "" : ", ") + std::string(key) + " = " + std::to_string(value);
  };
  change("columns", board.columns, seen.columns);
  change("rows", board.rows, seen.rows);
  change("first_id", board.first_id, seen.first_id);
  return "check [board] in session.toml against the print; the board in view has " +
         changes;
}

/// Returns an error with the other tags of the family that were seen.
Error no_tags(const CameraDetections& camera, const AprilGrid& board) {
  const std::string cause =
      "no tag of the calibration board (" + ids_of(board) + ") is seen in any frame";
  const auto layout = seen_layout(camera);
  if (layout) {
    return bad_input(camera.source,
                     cause + ", but others that are arranged as on " +
                         words_of(layout->columns, layout->rows, layout->first_id),
                     declare(*layout, board));
  }
  std::set<int> ids;
  int frames = 0;
  for (const FrameDetections& frame : camera.frames) {
    for (const TagDetection& tag : frame.tags) ids.insert(number(tag.id));
    frames += frame.tags.empty() ? 0 : 1;
  }
  return bad_input(
      camera.source,
      cause + (ids.empty()
                   ? std::string()
                   : "; " + std::to_string(frames) + " frames show tags between " +
                         std::to_string(*ids.begin()) + " and " +
                         std::to_string(*ids.rbegin())),
      "check that this is the calibration video, that [board] in session.toml names the "
      "printed ids and [tags] the family, and that the picture is sharp");
}

/// Returns an error for a camera with sufficient views and no plausible lens.
Error no_lens(const CameraDetections& camera,
              const CalibrationTarget& board,
              const std::string& frames) {
  constexpr double kStillShareOfWidth = 0.01;
  if (travel_px(camera, board) < kStillShareOfWidth * camera.width_px) {
    return bad_input(
        camera.source,
        "the board lies still in the " + frames +
            ": a single view does not determine the focal length",
        "record the calibration with a board that is moved and tilted in front of the "
        "cameras");
  }
  const auto* grid = std::get_if<AprilGrid>(&board);
  const auto layout = grid ? seen_layout(camera) : std::nullopt;
  if (layout && !layout_matches(*layout, *grid)) {
    return bad_input(camera.source,
                     "its tags are arranged as on " +
                         words_of(layout->columns, layout->rows, layout->first_id) +
                         ", but [board] is " +
                         words_of(grid->columns, grid->rows, grid->first_id),
                     declare(*layout, *grid));
  }
  if (layout) {
    return bad_input(camera.source,
                     "the board is never tilted enough in the " + frames +
                         " to determine the focal length",
                     "tilt the board by some 30 degrees, to all sides, while it is "
                     "filmed");
  }
  return bad_input(camera.source,
                   "no lens fits the board in the " + frames +
                       ": it never tilts, or [board] does not match the print",
                   "tilt the board while it is filmed, and check [board] in session.toml "
                   "against the print: rows, columns" +
                       std::string(grid ? ", sizes and first_id" : ""));
}

constexpr int kFramesForALens = 4;

Error seen_too_little(const CameraDetections& camera, const std::string& frames) {
  return bad_input(
      camera.source,
      "there are too few views of the board to calibrate this camera: " + frames,
      "record the calibration again: tilt the board, bring it close to this camera and "
      "into the corners of its picture");
}

Error too_few_tags(const CameraDetections& camera, const AprilGrid& board) {
  int tags_seen = 0;
  int frames_seen = 0;
  for (const FrameDetections& frame : camera.frames) {
    int here = 0;
    for (const TagDetection& tag : frame.tags) here += board.contains(tag.id);
    tags_seen += here;
    frames_seen += here >= 6;
  }
  if (tags_seen == 0) return no_tags(camera, board);
  const std::string frames = std::to_string(frames_seen) + " frames";
  if (frames_seen >= kFramesForALens) {
    return no_lens(camera, board, frames + " that show six tags or more");
  }
  return seen_too_little(camera, frames + " show six tags or more");
}

Error too_few_points(const CameraDetections& camera, const CalibrationTarget& board) {
  int points_seen = 0;
  int frames_seen = 0;
  for (const FrameDetections& frame : camera.frames) {
    points_seen += static_cast<int>(frame.points.size());
    frames_seen += frame.points.size() >= 12;
  }
  if (points_seen == 0) {
    return bad_input(camera.source,
                     "no corner of the calibration board is seen in any frame",
                     "check that this is the calibration video, that [board] in "
                     "session.toml has the board's kind, rows, columns and dictionary, "
                     "and that the picture is sharp");
  }
  const std::string frames = std::to_string(frames_seen) + " frames";
  if (frames_seen >= kFramesForALens) {
    return no_lens(camera, board, frames + " that show twelve corners or more");
  }
  return seen_too_little(camera, frames + " show twelve corners or more");
}

}  // namespace

Error too_few_views(const CameraDetections& camera, const CalibrationTarget& board) {
  if (const auto* grid = std::get_if<AprilGrid>(&board)) {
    return too_few_tags(camera, *grid);
  }
  return too_few_points(camera, board);
}

}  // namespace marey::calib
