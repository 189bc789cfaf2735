// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_target_seen.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>

#include "app/check/explain_missing_board.h"
#include "capture/search/detect_wrong_board.h"
#include "capture/search/survey_boards.h"
#include "core/base/assert.h"

namespace marey::app {

using recordings::Trial;
using recordings::TrialVideo;

namespace {

/// Returns the tags that are worn on bodies.
std::vector<TagFamilyUse> worn_tags(const recordings::Session& session) {
  std::vector<TagFamilyUse> worn;
  for (const TagOnSegment& tag : session.tags) {
    worn.push_back({session.family_of(tag.id), {tag.id}});
  }
  return worn;
}

Error no_board(const CameraDetections& camera,
               const CalibrationTarget& target,
               const std::vector<TagFamilyUse>& worn) {
  const std::string frames = std::to_string(camera.frames.size());
  const auto seen = capture::survey_boards(camera.source, target, worn);
  return bad_input(
      camera.source,
      "no " + name_of(target) + " is seen in its " + frames + " frames" +
          (seen ? ", but " + seen->what : std::string()),
      seen
          ? seen->remedy
          : "check that the video is of this trial, sharp and bright enough, and [board] "
            "in session.toml: rows and columns count squares");
}

/// Returns true if more than half of the frames show tags of the body.
bool shows_body(const recordings::Session& session, const CameraDetections& camera) {
  const auto is_worn = [&](const TagDetection& seen) {
    return std::any_of(session.tags.begin(), session.tags.end(), [&](const auto& tag) {
      return tag.id == seen.id;
    });
  };
  const auto frames = std::count_if(
      camera.frames.begin(), camera.frames.end(), [&](const FrameDetections& frame) {
        return std::any_of(frame.tags.begin(), frame.tags.end(), is_worn);
      });
  return 2 * frames > static_cast<std::ptrdiff_t>(camera.frames.size());
}

/// Returns true for tags of the common family, as a grid or a body has them.
bool shows_grid_tags(const capture::AlternativeTarget& seen) {
  return seen.kind == capture::AlternativeKind::kMarkers &&
         seen.codes == "DICT_APRILTAG_36h11" && !seen.is_mirrored;
}

/// Returns the largest number of detections in a frame: tags of an AprilGrid, points of a
/// board of squares, or all tags if the target is a wand.
int max_seen(const CameraDetections& camera, const CalibrationTarget& target) {
  std::ptrdiff_t max_count = 0;
  const auto* grid = std::get_if<AprilGrid>(&target);
  for (const FrameDetections& frame : camera.frames) {
    const auto tags =
        std::count_if(frame.tags.begin(), frame.tags.end(), [&](const TagDetection& tag) {
          return !grid || grid->contains(tag.id);
        });
    max_count = std::max(
        max_count,
        has_points(target) ? static_cast<std::ptrdiff_t>(frame.points.size()) : tags);
  }
  return static_cast<int>(max_count);
}

}  // namespace

Status check_board(const recordings::Session& session,
                   const std::vector<capture::CameraInput>& inputs,
                   const std::optional<CalibrationTarget>& target) {
  if (!target) return Done{};
  const auto other = capture::detect_wrong_board(inputs, *target, worn_tags(session));
  if (!other) return Done{};
  return bad_input(inputs[other->input].path.string(),
                   "no " + name_of(*target) + " is seen in " +
                       std::to_string(other->frames) +
                       " frames sampled from the whole video, but " + other->seen.what,
                   other->seen.remedy);
}

Status check_target_seen(const recordings::Session& session,
                         const Trial& trial,
                         const CameraDetections& camera,
                         const ContentToDetect& wanted) {
  const auto in_any = [&](const auto& shows) {
    return std::any_of(camera.frames.begin(), camera.frames.end(), shows);
  };
  const bool sees_tags = in_any([](const FrameDetections& f) { return !f.tags.empty(); });
  const bool sees_it = in_any([&](const FrameDetections& f) {
    if (wanted.target) return !f.points.empty();
    return std::any_of(f.tags.begin(), f.tags.end(), [&](const TagDetection& tag) {
      return !wanted.grid || wanted.grid->contains(tag.id);
    });
  });
  if (sees_it) return Done{};
  if (wanted.target || wanted.shows_grid) {
    if (const auto other = explain_missing_board(session, trial, camera)) return *other;
  }
  if (wanted.target) return no_board(camera, *wanted.target, worn_tags(session));
  if (wanted.grid && sees_tags) {
    // The person who holds the board may also wear tags. Undeclared tags are reported in
    // a later check.
    const auto seen = capture::survey_boards(camera.source, AprilGrid{});
    if (!seen || shows_grid_tags(*seen)) return Done{};
    // Floors and windows resemble chessboards; a body in most of the frames shows another
    // trial.
    if (seen->kind == capture::AlternativeKind::kChessboard &&
        shows_body(session, camera)) {
      return bad_input(camera.source,
                       "no tag of the " + name_of(*wanted.grid) +
                           " is seen, but tags of the body are: it looks like the video "
                           "of another trial",
                       "name the camera's own video in `videos` of trial " + trial.name);
    }
    return bad_input(camera.source,
                     "no tag of the " + name_of(*wanted.grid) + " is seen in its " +
                         std::to_string(camera.frames.size()) + " frames, but " +
                         seen->what,
                     seen->remedy);
  }
  std::string cause =
      "no tag is seen in its " + std::to_string(camera.frames.size()) + " frames";
  if (wanted.shows_grid) {
    if (const auto seen = capture::survey_boards(camera.source, AprilGrid{})) {
      return bad_input(camera.source, cause + ", but " + seen->what, seen->remedy);
    }
  }
  return bad_input(
      camera.source,
      cause,
      "check that the video is of this trial and sharp, and the tag family in "
      "session.toml; or leave this camera out of the trial");
}

Status check_floor_seen(const recordings::Session& session,
                        const Trial& trial,
                        const std::vector<CameraDetections>& found,
                        const ContentToDetect& wanted,
                        std::vector<Finding>& findings) {
  // The limit of calib::board_views(). Tags on the floor are triangulated from two
  // cameras.
  const int enough = has_points(session.target) ? 6 : 3;
  const bool is_wand = std::holds_alternative<Wand>(session.target);
  const CameraDetections* first_poor = nullptr;
  std::string good;
  std::vector<Finding> poor_views;
  for (const TrialVideo& video : trial.videos) {
    const CameraDetections& camera = found[index(video.camera)];
    if (camera.frames.empty()) continue;
    const std::string& name = session.cameras[index(video.camera)];
    const int seen = max_seen(camera, session.target);
    if (seen >= (is_wand ? 1 : enough)) {
      good += (good.empty() ? "" : ", ") + name;
      continue;
    }
    if (!first_poor) first_poor = &camera;
    // The whole video is searched, not only the range of frames of the trial.
    Trial whole = trial;
    whole.frames.reset();
    if (seen == 0 && (wanted.target || wanted.shows_grid)) {
      if (const auto other = explain_missing_board(session, whole, camera)) return *other;
    }
    poor_views.push_back(fair_finding(
        "floor-view",
        camera.source,
        "camera \"" + name + "\" sees " +
            (seen == 0 ? std::string("nothing")
                       : std::to_string(seen) +
                             (has_points(session.target) ? " points" : " tags")) +
            (is_wand ? " on the floor" : " of the board on the floor")));
  }
  if (good.empty()) {
    return first_poor ? check_target_seen(session, trial, *first_poor, wanted) : Done{};
  }
  for (Finding& one : poor_views) {
    one.cause += ", too little: the floor is taken from " + good;
    findings.push_back(std::move(one));
  }
  return Done{};
}

}  // namespace marey::app
